// Reads the arrays of a motion into a track.
#include <fmt/format.h>

#include "app/base/json.h"
#include "app/base/npz.h"
#include "app/trust/track.h"

namespace app {

namespace {

constexpr std::uint64_t kPoseNumbers = 7, kVelocityNumbers = 6;

// NumPy pads texts with zeros.
std::vector<std::string> textsOf(const NpzFile& file, int array) {
  const std::uint64_t width = file.array(array).rowBytes(), count = file.rows(array);
  std::string all(width * count, '\0');
  file.read(array, 0, count, all.data());
  std::vector<std::string> texts;
  for (std::uint64_t k = 0; k < count; ++k) {
    texts.push_back(all.substr(k * width, width).c_str());
  }
  return texts;
}

bool isOf(const NpzFile& file, int array, std::uint64_t bodies, std::uint64_t numbers) {
  const NpzArray& of = file.array(array);
  return of.type == "<f8" && of.shape.size() == 3 && of.shape[1] == bodies &&
         of.shape[2] == numbers;
}

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw scenes::InputError(file.string() + ": no motion: expected what simulate --motion writes");
}

}  // namespace

Track readMotion(const std::filesystem::path& path) {
  const NpzFile file = NpzFile::open(path);
  const int pose = file.find("pose"), velocity = file.find("velocity");
  const int names = file.find("names"), about = file.find("about");
  if (pose < 0 || names < 0 || about < 0 || file.rows(about) == 0) refuse(path);
  Track track;
  track.names = textsOf(file, names);
  const std::size_t bodies = track.names.size();
  track.hasVelocities = velocity >= 0 && file.rows(velocity) == file.rows(pose);
  if (!isOf(file, pose, bodies, kPoseNumbers)) refuse(path);
  if (track.hasVelocities && !isOf(file, velocity, bodies, kVelocityNumbers)) refuse(path);
  const auto json = tryParseJson(textsOf(file, about).front());
  const int fps = json.is_object() ? json.value("fps", 0) : 0;
  if (fps < 1) refuse(path);
  std::vector<double> x(bodies * kPoseNumbers), v(bodies * kVelocityNumbers);
  for (std::uint64_t f = 0; f < file.rows(pose); ++f) {
    file.read(pose, f, 1, x.data());
    if (track.hasVelocities) file.read(velocity, f, 1, v.data());
    TrackFrame frame;
    frame.time = static_cast<double>(f) / fps;
    for (std::size_t b = 0; b < bodies; ++b) {
      const double *p = &x[b * kPoseNumbers], *u = &v[b * kVelocityNumbers];
      frame.poses.push_back({{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}});
      frame.velocities.push_back({{u[0], u[1], u[2]}, {u[3], u[4], u[5]}});
    }
    track.frames.push_back(std::move(frame));
  }
  if (track.frames.empty()) refuse(path);
  return track;
}

}  // namespace app
