// What shards are called, and how their frames come together.
#include "app/run/shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <system_error>

#include "app/base/output_file.h"
#include "app/run/frame_folder.h"
#include "app/run/frame_range.h"
#include "scenes/joined.h"

namespace app {

namespace fs = std::filesystem;

namespace {

struct Written {
  Shard shard;
  fs::path folder;
  RunRecord record;
};

std::vector<Written> findShards(const fs::path& folder) {
  std::vector<Written> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "jobs", error)) {
    Shard shard;
    const std::string name = entry.path().filename().string();
    if (std::sscanf(name.c_str(), "%d-of-%d", &shard.index, &shard.count) != 2) continue;
    if (std::optional<RunRecord> record = readRecord(entry.path())) {
      found.push_back({shard, entry.path(), std::move(*record)});
    }
  }
  std::sort(found.begin(), found.end(), [](const Written& a, const Written& b) {
    return std::pair(a.shard.count, a.shard.index) < std::pair(b.shard.count, b.shard.index);
  });
  return found;
}

// The same scene on the same program has the same states on every machine, or one is not what its
// frames say.
void takeStates(const Written& from, RunRecord& record) {
  const std::size_t frames = std::max(record.stateHashes.size(), from.record.stateHashes.size());
  record.stateHashes.resize(frames);
  for (std::size_t frame = 0; frame < from.record.stateHashes.size(); ++frame) {
    const std::string& theirs = from.record.stateHashes[frame];
    std::string& ours = record.stateHashes[frame];
    if (ours.empty()) ours = theirs;
    if (theirs.empty() || ours == theirs) continue;
    throw CheckFailed(
        fmt::format("{}: its state of frame {} is not that of the other jobs; the "
                    "machines do not compute the same",
                    from.folder.string(), frame));
  }
}

void takeRecord(const Written& from, RunRecord& record) {
  takeStates(from, record);
  if (record.expectations.empty()) record.expectations = from.record.expectations;
  if (record.accuracy.is_null()) record.accuracy = from.record.accuracy;
  for (const auto& [stage, spent] : from.record.seconds.items()) {
    record.addSeconds(stage, spent.get<double>());
  }
}

// A second name of the same file costs nothing; across file systems it is a copy.
void takeFile(const fs::path& from, const fs::path& to) {
  const fs::path half = to.string() + kPartial;
  std::error_code error;
  if (fs::equivalent(from, to, error)) return;  // it has that name; renaming would do nothing
  fs::remove(half, error);
  fs::create_hard_link(from, half, error);
  if (error) fs::copy_file(from, half, fs::copy_options::overwrite_existing, error);
  if (!error) fs::rename(half, to, error);
  if (error) throw EnvironmentError("cannot write " + to.string() + ": " + error.message());
}

}  // namespace

std::string framesOf(const Shard& shard, const std::vector<int>& frames) {
  std::vector<int> share;
  for (auto k = static_cast<std::size_t>(shard.index); k < frames.size();
       k += static_cast<std::size_t>(shard.count)) {
    share.push_back(frames[k]);
  }
  return frameRangeText(share);
}

fs::path folderOf(const Shard& shard, const fs::path& folder) {
  return folder / "jobs" / fmt::format("{}-of-{}", shard.index, shard.count);
}

namespace {

void takeRecords(const std::vector<Written>& shards, RunRecord& record) {
  for (const Written& from : shards) {
    if (!from.record.sameFrames(record)) {
      throw scenes::InputError(fmt::format(
          "{} is of a run that differs in (was -> would be)\n  {}", from.folder.string(),
          scenes::joined(differencesOf(from.record, record), "\n  ")));
    }
    takeRecord(from, record);
  }
}

}  // namespace

Collected collectFrames(const scenes::Scene& scene, const RenderJob& job) {
  std::vector<Written> shards = findShards(job.folder);
  if (shards.empty()) {
    throw scenes::InputError(
        fmt::format("--collect: no job has drawn into {} yet; --jobs N prints their commands",
                    (job.folder / "jobs").string()));
  }
  Collected collected;
  RunRecord& record = collected.result.record = makeRecord(scene);
  notePicture(job, {}, record);
  record.picture["renderer"] = shards.front().record.picture.value("renderer", Json());
  takeRecords(shards, record);
  const FrameFolder frames(job.folder);
  const int shardCount = shards.back().shard.count;
  std::vector<bool> misses(static_cast<std::size_t>(shardCount));
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    const int frame = job.frames[i];
    const auto has = [&](const FrameFolder& folder) {
      return folder.has(frame, job.renderer.width, job.renderer.height);
    };
    const auto from = std::find_if(shards.begin(), shards.end(), [&](const Written& written) {
      return has(FrameFolder(written.folder));
    });
    if (from != shards.end()) takeFile(FrameFolder(from->folder).file(frame), frames.file(frame));
    if (from != shards.end() || has(frames)) {
      ++collected.result.kept;
    } else {
      misses[i % static_cast<std::size_t>(shardCount)] = true;
    }
  }
  for (int k = 0; k < shardCount; ++k) {
    if (misses[static_cast<std::size_t>(k)]) collected.missing.push_back({k, shardCount});
  }
  record.finished = collected.missing.empty();
  writeRecord(record, job.folder);
  return collected;
}

}  // namespace app
