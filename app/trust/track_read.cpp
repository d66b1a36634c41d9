// Reads a trajectory table back into the track that it was written from.
#include <fmt/format.h>

#include <charconv>
#include <fstream>

#include "app/base/csv.h"
#include "app/trust/track.h"

namespace app {

namespace {

constexpr std::size_t kNumbers = 13;

struct TrajectoryRow {
  int frame = 0;
  double time = 0;
  std::string body;
  double of[kNumbers] = {};
};

// Takes the next field of a line; false where there is none, or a quote is left open.
bool takeField(std::string_view& line, std::string& field) {
  field.clear();
  if (!line.starts_with('"')) {
    const std::size_t comma = line.find(',');
    field = line.substr(0, comma);
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    return true;
  }
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] != '"') {
      field += line[i];
    } else if (i + 1 < line.size() && line[i + 1] == '"') {
      field += line[i++];
    } else {
      line.remove_prefix(std::min(line.size(), i + 2));
      return true;
    }
  }
  return false;
}

template <class Number>
bool takeNumber(std::string_view& line, Number& number) {
  std::string field;
  if (!takeField(line, field)) return false;
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, number);
  return error == std::errc() && stop == end;
}

bool readRow(std::string_view line, TrajectoryRow& row) {
  if (!takeNumber(line, row.frame) || !takeNumber(line, row.time) || !takeField(line, row.body)) {
    return false;
  }
  for (double& number : row.of) {
    if (!takeNumber(line, number)) return false;
  }
  return line.empty();
}

class TrackReader {
 public:
  explicit TrackReader(const std::filesystem::path& file) : file_(file.string()) {
    track_.names = {"world"};
  }

  void take(const std::string& line) {
    ++line_;
    TrajectoryRow row;
    if (!readRow(line, row)) fail("expected " + std::to_string(kNumbers + 3) + " fields of a body");
    if (row.frame == track_.frameCount()) begin(row);
    if (row.frame + 1 != track_.frameCount()) fail("expected frames 0, 1, 2 ... in order");
    TrackFrame& frame = track_.frames.back();
    if (row.frame == 0) track_.names.push_back(row.body);
    const std::size_t place = frame.poses.size();
    if (place >= track_.names.size() || track_.names[place] != row.body) {
      fail("expected the bodies of frame 0 in the same order");
    }
    const double* n = row.of;
    frame.poses.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}});
    frame.velocities.push_back({{n[7], n[8], n[9]}, {n[10], n[11], n[12]}});
  }
  Track finish() {
    if (track_.frames.empty()) fail("expected at least one frame");
    requireWhole();
    return std::move(track_);
  }

 private:
  void begin(const TrajectoryRow& row) {
    if (row.frame > 0) requireWhole();
    track_.frames.push_back({row.time, {physics::Pose{}}, {physics::Velocity{}}, {}});
  }
  void requireWhole() const {
    if (track_.frames.back().poses.size() != track_.names.size()) {
      fail(fmt::format("frame {} has {} bodies, and frame 0 has {}", track_.frameCount() - 1,
                       track_.frames.back().poses.size() - 1, track_.names.size() - 1));
    }
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw scenes::InputError(fmt::format("{}:{}: no trajectory: {}", file_, line_, why));
  }

  std::string file_;
  int line_ = 1;  // the header
  Track track_;
};

}  // namespace

Track readTrajectory(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  if (!stream) throw scenes::InputError(file.string() + ": cannot be read");
  if (!std::getline(stream, line) || line + "\n" != trajectoryHeader()) {
    throw scenes::InputError(fmt::format(
        "{}: no trajectory: expected the table of simulate --trajectory, which begins with {}",
        file.string(), trajectoryHeader().substr(0, trajectoryHeader().size() - 1)));
  }
  TrackReader reader(file);
  while (std::getline(stream, line)) reader.take(line);
  return reader.finish();
}

}  // namespace app
