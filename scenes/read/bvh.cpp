// Reads motion capture files.
#include "scenes/read/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "physics/base/rotation.h"
#include "scenes/read/input_error.h"

namespace scenes {
namespace {

using physics::Quat;
using physics::Vec3;

constexpr const char* kChannels[] = {"Xposition", "Yposition", "Zposition",
                                     "Xrotation", "Yrotation", "Zrotation"};

std::optional<double> numberIn(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || !std::isfinite(number)) return {};
  return number;
}

// The words of a file, line after line.
class BvhWords {
 public:
  BvhWords(const std::string& text, const std::string& path) : text_(text), path_(path) {}

  std::string next() {
    std::string word;
    while (!(line_ >> word)) {
      if (!nextLine()) expected("more", "the end of the file");
    }
    return word;
  }
  void take(const char* wanted) {
    if (const std::string word = next(); word != wanted) expected(wanted, word);
  }
  double number() {
    const std::string word = next();
    const std::optional<double> number = numberIn(word);
    if (!number) expected("a number", word);
    return *number;
  }
  // The numbers of a line of its own; none at the end of the file.
  std::vector<double> numbers() {
    std::vector<double> row;
    while (row.empty() && nextLine()) {
      for (std::string word; line_ >> word;) {
        const std::optional<double> number = numberIn(word);
        if (!number) expected("a number", word);
        row.push_back(*number);
      }
    }
    return row;
  }
  [[noreturn]] void expected(const std::string& what, const std::string& got) const {
    throw InputError(fmt::format("{}:{}: expected {}, got '{}'", path_, number_, what, got));
  }

 private:
  bool nextLine() {
    std::string line;
    if (!std::getline(text_, line)) return false;
    ++number_;
    line_ = std::istringstream(line);
    return true;
  }

  std::istringstream text_, line_;
  std::string path_;
  int number_ = 0;
};

BvhChannel channelOf(const std::string& word, const BvhWords& words) {
  const auto found = std::find(std::begin(kChannels), std::end(kChannels), word);
  if (found == std::end(kChannels)) words.expected("a channel such as Zrotation", word);
  return static_cast<BvhChannel>(found - std::begin(kChannels));
}

// { OFFSET x y z, and of a joint CHANNELS n ...
void readHead(BvhWords& words, BvhJoint& joint) {
  words.take("{");
  words.take("OFFSET");
  for (int k = 0; k < 3; ++k) joint.offset[k] = words.number();
  if (joint.name.empty()) return;
  words.take("CHANNELS");
  const double count = words.number();
  if (count < 0 || count > 6 || count != std::floor(count)) {
    words.expected("at most 6 channels", fmt::format("{}", count));
  }
  for (int k = 0; k < count; ++k) joint.channels.push_back(channelOf(words.next(), words));
}

void readHierarchy(BvhWords& words, Bvh& bvh) {
  words.take("HIERARCHY");
  words.take("ROOT");
  int inside = -1;  // the joint whose brace is open
  std::string word = "ROOT";
  do {
    if (word == "}") {
      inside = bvh.joints[inside].parent;
      continue;
    }
    const bool isEnd = word == "End";
    if (isEnd) words.take("Site");
    if (!isEnd && word != "JOINT" && word != "ROOT") words.expected("JOINT, End Site or }", word);
    if (inside >= 0 && bvh.joints[inside].name.empty()) words.expected("}", word);
    BvhJoint joint{isEnd ? "" : words.next(), inside, Vec3::Zero(), {}};
    if (!isEnd && bvh.find(joint.name) >= 0) words.expected("a new name", joint.name);
    readHead(words, joint);
    inside = static_cast<int>(bvh.joints.size());
    bvh.joints.push_back(std::move(joint));
  } while (inside >= 0 && (word = words.next(), true));
}

void readMotion(BvhWords& words, Bvh& bvh) {
  words.take("MOTION");
  words.take("Frames:");
  const double count = words.number();
  words.take("Frame");
  words.take("Time:");
  bvh.frameTime = words.number();
  if (!(bvh.frameTime > 0)) {
    words.expected("a time of a frame > 0 s", fmt::format("{}", bvh.frameTime));
  }
  std::size_t channels = 0;
  for (const BvhJoint& joint : bvh.joints) channels += joint.channels.size();
  for (auto row = words.numbers(); !row.empty(); row = words.numbers()) {
    if (row.size() != channels) {
      words.expected(fmt::format("{} numbers, one for each channel", channels),
                     fmt::format("{}", row.size()));
    }
    bvh.frames.push_back(std::move(row));
  }
  if (bvh.frames.empty() || static_cast<double>(bvh.frames.size()) != count) {
    words.expected(fmt::format("{} frames, at least one", count),
                   fmt::format("{}", bvh.frames.size()));
  }
}

}  // namespace

int Bvh::find(const std::string& name) const {
  const auto isIt = [&](const BvhJoint& joint) { return joint.name == name; };
  const auto found = std::find_if(joints.begin(), joints.end(), isIt);
  return found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

std::vector<Vec3> Bvh::restPoints() const {
  std::vector<Vec3> points;
  for (const BvhJoint& joint : joints) {
    points.push_back(joint.parent < 0 ? Vec3(Vec3::Zero())
                                      : Vec3(points[joint.parent] + joint.offset));
  }
  return points;
}

// The first channel is the outermost turn.
std::vector<Quat> Bvh::turns(std::size_t frame) const {
  std::vector<Quat> out;
  std::size_t at = 0;
  for (const BvhJoint& joint : joints) {
    Quat turn = joint.parent < 0 ? Quat::Identity() : out[joint.parent];
    for (const BvhChannel channel : joint.channels) {
      const double value = frames[frame][at++];
      const int axis = static_cast<int>(channel) - static_cast<int>(BvhChannel::kTurnX);
      if (axis >= 0)
        turn = turn * physics::exponential(value * physics::kPi / 180 * Vec3::Unit(axis));
    }
    out.push_back(turn.normalized());
  }
  return out;
}

Vec3 Bvh::rootAt(std::size_t frame) const {
  Vec3 at = joints[0].offset;
  for (std::size_t k = 0; k < joints[0].channels.size(); ++k) {
    const int axis = static_cast<int>(joints[0].channels[k]);
    if (axis < 3) at[axis] += frames[frame][k];
  }
  return at;
}

Bvh parseBvh(const std::string& text, const std::string& path) {
  BvhWords words(text, path);
  Bvh bvh;
  readHierarchy(words, bvh);
  readMotion(words, bvh);
  return bvh;
}

}  // namespace scenes
