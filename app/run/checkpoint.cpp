// Checkpoints: when they are written, and what stands before the state.
#include "app/run/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/build_info.h"
#include "app/base/output_file.h"
#include "scenes/joined.h"
#include "scenes/read/file_text.h"

namespace app {

namespace {

const std::string kMagic = "dbd checkpoint 1\n";
constexpr double kShare = 0.02;   // of a run's time
constexpr double kUsual = 0.002;  // s that one takes, as long as none has been written

// Of bytes that end in their own hash; none: they do not.
std::optional<std::string_view> withoutHash(std::string_view bytes) {
  const std::size_t hash = hashText("").size();
  if (bytes.size() < kMagic.size() + hash || !bytes.starts_with(kMagic)) return std::nullopt;
  const std::string_view state = bytes.substr(0, bytes.size() - hash);
  if (hashText(state) != bytes.substr(state.size())) return std::nullopt;
  return state.substr(kMagic.size());
}

RunRecord recordOf(const Json& run) {
  RunRecord record;
  record.program = run.value("program", Json());
  record.scene = run.value("scene", Json());
  record.settings = run.value("settings", Json());
  return record;
}

}  // namespace

Checkpoint::Checkpoint(const std::filesystem::path& motion, Json run)
    : file_(motion.string() + ".state"), run_(std::move(run)), cost_(kUsual) {}

Json Checkpoint::runOf(const RunRecord& record, int frames, int keeps) {
  return {{"program", record.program},
          {"scene", record.scene},
          {"settings", record.settings},
          {"frames", frames},
          {"keeps", keeps}};
}

std::optional<physics::Archive> Checkpoint::open() {
  bytes_ = scenes::fileText(file_.string()).value_or("");
  const std::optional<std::string_view> state = withoutHash(bytes_);
  if (!state) return std::nullopt;
  physics::Archive archive(*state);
  std::string text;
  archive(text);
  const Json was = tryParseJson(text);
  if (!recordOf(was).sameStates(recordOf(run_))) refuse(was);
  if (was != run_) return std::nullopt;
  return archive;
}

void Checkpoint::refuse(const Json& was) const {
  const std::vector<std::string> differences = differencesOf(recordOf(was), recordOf(run_));
  throw scenes::InputError(
      fmt::format("{} is of a run that was stopped and differs in (was -> would be)\n  {}\nNothing "
                  "was deleted. --fresh begins anew.",
                  file_.string(), scenes::joined(differences, "\n  ")));
}

void Checkpoint::pass(const Members& members) {
  if (sinceLast_.seconds() >= cost_ / kShare) write(members);
}

// What one takes is taken to be no more than twice what the last did: a single one may have had to
// wait for the processor.
void Checkpoint::write(const Members& members) {
  const Stopwatch watch;
  std::string& bytes = bytes_;
  bytes = kMagic;
  physics::Archive archive(bytes);
  std::string run = jsonText(run_);
  archive(run);
  members(archive);
  bytes += hashText(bytes);
  rewriteFile(file_, bytes);
  const double took = watch.seconds();
  seconds_ += took;
  cost_ = std::min(took, 2 * cost_);
  sinceLast_ = Stopwatch();
}

void Checkpoint::end(const Members& members) {
  write(members);
  removeFile(spareOf(file_));
}

void Checkpoint::remove() {
  removeFile(file_);
  removeFile(spareOf(file_));
}

}  // namespace app
