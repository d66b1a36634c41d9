// [[bvh]]: a figure whose drives follow a motion capture file.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "physics/base/rotation.h"
#include "scenes/joined.h"
#include "scenes/read/bvh.h"
#include "scenes/read/ragdoll_words.h"
#include "scenes/read/read_body.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Quat;
using physics::Vec3;

// Beside the scene, else in assets/motions.
Bvh readMotionFile(TableReader& reader) {
  namespace fs = std::filesystem;
  std::string name;
  reader(Field{"file", physics::Unit::kNone, true}, name);
  const Value& value = *reader.table().find("file");
  const fs::path beside = fs::path(folderOf(reader.context(), value.place)) / name;
  const fs::path asset = fs::path(assetFolder()) / "motions" / name;
  std::error_code ignored;
  const bool isBeside = fs::is_regular_file(beside, ignored);
  if (!isBeside && !fs::is_regular_file(asset, ignored)) {
    reader.failAt("file", fmt::format("no file '{}' beside the scene or in assets/motions", name));
  }
  const std::string path = (isBeside ? beside : asset).string();
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return parseBvh(text.str(), path);
}

// By bone the joint of the file, -1: none. Where it is not said, the one of the same name.
std::vector<int> readJoints(TableReader& reader, const physics::Skeleton& skeleton,
                            const Bvh& bvh) {
  std::vector<int> joints;
  for (const physics::Bone& bone : skeleton.bones) joints.push_back(bvh.find(bone.name));
  std::vector<std::string> known;
  for (const BvhJoint& joint : bvh.joints) {
    if (!joint.name.empty()) known.push_back(joint.name);
  }
  if (const Value* table = reader.take("joints"); table != nullptr) {
    if (!table->isTable())
      failExpected(reader.spot({"joints"}), *table, "a table bone = \"joint\"");
    Context context = reader.context();
    context.glossary = nullptr;  // bones are not words
    TableReader names(*table, "bvh.joints", context);
    for (std::size_t b = 0; b < joints.size(); ++b) {
      const std::string& bone = skeleton.bones[b].name;
      const Value* value = names.take(bone);
      if (value == nullptr) continue;
      std::string name;
      readValue(*value, names.spot({bone.c_str()}), name);
      joints[b] = bvh.find(name);
      if (name.empty() || joints[b] < 0) {
        names.failAt(bone.c_str(),
                     fmt::format("no joint '{}' in the file{}", name, nearestOrAll(name, known)));
      }
    }
    names.finish();
  }
  if (std::all_of(joints.begin(), joints.end(), [](int joint) { return joint < 0; })) {
    reader.failHere(
        fmt::format("expected 'joints', bone = \"joint\": no bone has the name of one "
                    "of the file's, {}",
                    joined(known, ", ")));
  }
  return joints;
}

// Takes the turns of a file's joints to bones, both from rest.
struct Retarget {
  const physics::Skeleton& skeleton;
  const Bvh& bvh;
  std::vector<int> joints;     // by bone
  std::vector<Quat> atRest{};  // by bone, from the skeleton's rest to the file's

  // The joint at which one bone goes on from the end of another; null: none or several.
  const physics::SkeletonJoint* nextOf(int bone) const {
    const physics::SkeletonJoint* next = nullptr;
    for (const physics::SkeletonJoint& joint : skeleton.joints) {
      if (joint.parent != bone) continue;
      if (next != nullptr || joints[joint.child] < 0) return nullptr;
      next = &joint;
    }
    return next;
  }

  // Arms that one has at rest by the sides, the other held out: a bone from joint to joint points
  // there as in the file, and what goes on from it follows.
  void findRest() {
    const std::vector<Vec3> points = bvh.restPoints();
    atRest.assign(skeleton.bones.size(), Quat::Identity());
    for (const physics::SkeletonJoint& joint : skeleton.joints) {
      Quat& turn = atRest[joint.child] = atRest[joint.parent];
      const physics::SkeletonJoint* next = nextOf(joint.child);
      if (next == nullptr || joints[joint.child] < 0) continue;
      const Vec3 here = turn * (next->at - joint.at);
      const Vec3 there = points[joints[next->child]] - points[joints[joint.child]];
      if (here.isZero(0) || there.isZero(0)) continue;
      turn = physics::turnBetween(here.normalized(), there.normalized()) * turn;
    }
  }

  // By joint of the skeleton, and of the first bone.
  physics::JointTurns turnsAt(std::size_t frame, Quat& root) const {
    const std::vector<Quat> turns = bvh.turns(frame);
    const auto turnOf = [&](int bone, const Quat& otherwise) {
      return joints[bone] < 0 ? otherwise : Quat(turns[joints[bone]] * atRest[bone]);
    };
    std::vector<Quat> bones(skeleton.bones.size(), Quat::Identity());
    root = bones[0] = turnOf(0, turns[0]);
    physics::JointTurns out;
    for (const physics::SkeletonJoint& joint : skeleton.joints) {
      bones[joint.child] = turnOf(joint.child, bones[joint.parent]);
      out.push_back((bones[joint.parent].conjugate() * bones[joint.child]).normalized());
    }
    return out;
  }
};

// m, of the file's unit: both stand as high above their feet.
double scaleOf(const TableReader& reader, const physics::Skeleton& skeleton, const Bvh& bvh) {
  double lowest = 0;
  for (const Vec3& point : bvh.restPoints()) lowest = std::min(lowest, point.y());
  if (!(lowest < 0)) reader.failHere("expected 'scale': nothing in the file is below its root");
  return skeleton.bones[0].rest.x.y() / -lowest;
}

void takeKeys(const Retarget& retarget, double scale, RagdollWords& words) {
  const Bvh& bvh = retarget.bvh;
  const Quat placed = words.def.place.rotation;
  Quat first;
  words.start = retarget.turnsAt(0, first);
  words.def.place.rotation = (placed * first).normalized();
  for (std::size_t f = 0; f < bvh.frames.size(); ++f) {
    PoseScript::Key& key = words.script.keys.emplace_back();
    key.time = static_cast<double>(f) * bvh.frameTime;
    Quat root;
    key.targets = targetsOf(words.skeleton, retarget.turnsAt(f, root));
    key.root.x = placed * (scale * (bvh.rootAt(f) - bvh.rootAt(0)));
    key.root.q = (placed * root * first.conjugate() * placed.conjugate()).normalized();
  }
}

}  // namespace

void readBvh(TableReader& reader, Recipe& recipe) {
  const std::string name = readName(reader, "bvh");
  RagdollWords words;
  readFigure(reader, recipe, words);
  if (!words.def.drive) reader.failHere("expected a 'drive', which follows the file");
  const Bvh bvh = readMotionFile(reader);
  Retarget retarget{words.skeleton, bvh, readJoints(reader, words.skeleton, bvh)};
  retarget.findRest();
  std::optional<double> scale;
  reader(Field{"scale", physics::Unit::kNone, false, kPositive}, scale);
  words.def.leads = true;
  reader(Field{"held"}, words.def.leads);
  reader(Field{"repeat"}, words.script.repeat);
  if (words.script.repeat && bvh.frames.size() < 2) {
    reader.failAt("repeat", "expected at least two frames to repeat");
  }
  words.script.isCaptured = true;
  takeKeys(retarget, scale ? *scale : scaleOf(reader, words.skeleton, bvh), words);
  addFigure(reader, recipe, std::move(words), name);
}

}  // namespace scenes
