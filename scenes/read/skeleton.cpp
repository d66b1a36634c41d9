// [[bone]] [[joint]] [[apart]] of a skeleton file, [joints] of a pose file.
#include "scenes/read/skeleton.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "physics/base/rotation.h"
#include "scenes/read/file_text.h"
#include "scenes/read/settings_reader.h"
#include "scenes/scene.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;
using physics::Field;
using physics::Unit;
using physics::Vec3;

std::string findAsset(const Value& value, const Spot& spot, const char* folder) {
  if (!value.isString()) failExpected(spot, value, "a name");
  const fs::path beside = fs::path(folderOf(spot.context, value.place)) / (value.text + ".toml");
  const fs::path asset = fs::path(assetFolder()) / folder / (value.text + ".toml");
  std::error_code ignored;
  if (fs::is_regular_file(asset, ignored)) return asset.string();
  if (fs::is_regular_file(beside, ignored)) return beside.string();
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(asset.parent_path(), ignored)) {
    names.push_back(entry.path().stem().string());
  }
  fail(spot.context, value.place,
       fmt::format("{}: no '{}' in assets/{} or beside the scene{}", spot.key, value.text, folder,
                   didYouMean(value.text, names)));
}

Value readAsset(const std::string& path) {
  const std::optional<std::string> text = fileText(path);
  if (!text) throw InputError(path + ": expected a file that can be read");
  return parseToml(*text, path);
}

void readBone(TableReader& reader, physics::Skeleton& skeleton) {
  physics::Bone bone;
  reader(Field{"name", Unit::kNone, true}, bone.name);
  reader(Field{"shape", Unit::kNone, true}, bone.shape);
  reader(Field{"mass", Unit::kNone, true, kPositive}, bone.mass);
  reader(Field{"position", Unit::kPoint, true}, bone.rest.x);
  reader(Field{"rotation"}, bone.rest.q);
  skeleton.bones.push_back(std::move(bone));
}

void readBall(TableReader& reader, physics::SkeletonJoint& joint) {
  reader(Field{"direction", Unit::kDirection, true}, joint.axis);
  joint.centre = joint.axis;
  reader(Field{"cone_centre", Unit::kDirection}, joint.centre);
  reader(Field{"cone_degrees", Unit::kDegrees, true, 0, 180}, joint.cone);
  reader(Field{"twist_degrees", Unit::kDegrees, true, -180, 180}, joint.limits);
}

void readHinge(TableReader& reader, physics::SkeletonJoint& joint) {
  joint.hinge = true;
  reader(Field{"hinge_axis", Unit::kDirection, true}, joint.axis);
  reader(Field{"limits_degrees", Unit::kDegrees, true, -180, 180}, joint.limits);
}

void readJoint(TableReader& reader, physics::Skeleton& skeleton) {
  physics::SkeletonJoint joint;
  std::array<physics::BodyId, 2> bones{};
  reader(Field{"bones", Unit::kNone, true}, bones);
  joint.parent = bones[0];
  joint.child = bones[1];
  reader(Field{"at", Unit::kPoint, true}, joint.at);
  reader(Field{"strength", Unit::kNone, false, kPositive}, joint.strength);
  if (reader.has("hinge_axis")) {
    readHinge(reader, joint);
  } else {
    readBall(reader, joint);
  }
  joint.axis = joint.axis.stableNormalized();
  joint.centre = joint.centre.stableNormalized();
  if (joint.child == 0) reader.failAt("bones", "expected a child other than the first bone");
  bool known = joint.parent == 0;
  for (const physics::SkeletonJoint& other : skeleton.joints) {
    known = known || other.child == joint.parent;
    if (other.child == joint.child) reader.failAt("bones", "expected a child with one parent only");
  }
  if (!known) reader.failAt("bones", "expected a parent that an earlier joint holds");
  skeleton.joints.push_back(joint);
}

// Turns about x, then y, then z, in degrees.
physics::Quat turnOf(const Vec3& degrees) {
  const Vec3 angle = degrees * M_PI / 180;
  return physics::exponential(angle.z() * Vec3::UnitZ()) *
         physics::exponential(angle.y() * Vec3::UnitY()) *
         physics::exponential(angle.x() * Vec3::UnitX());
}

}  // namespace

physics::Skeleton readSkeleton(const Value& value, const Spot& spot) {
  const std::string path = findAsset(value, spot, "skeletons");
  const Value tree = readAsset(path);
  std::map<std::string, physics::BodyId> bones;
  Context context{path, &bones};
  physics::Skeleton skeleton;
  std::string title;
  TableReader root(tree, "", context);
  root(Field{"title"}, title);
  readTables(root, "bone", [&](TableReader& reader) {
    readBone(reader, skeleton);
    const int index = static_cast<int>(skeleton.bones.size()) - 1;
    if (!bones.emplace(skeleton.bones.back().name, index).second) {
      reader.failAt("name", "expected a new name, a bone has this one already");
    }
  });
  if (skeleton.bones.empty()) root.failHere("expected at least one [[bone]]");
  readTables(root, "joint", [&](TableReader& reader) { readJoint(reader, skeleton); });
  readTables(root, "apart", [&](TableReader& reader) {
    reader(Field{"bones", Unit::kNone, true}, skeleton.apart.emplace_back());
  });
  root.finish();
  return skeleton;
}

physics::JointTurns readTurns(const Value& value, const Spot& spot,
                              const physics::Skeleton& skeleton) {
  const std::string path = findAsset(value, spot, "poses");
  const Value tree = readAsset(path);
  const Context context{path, nullptr};
  physics::JointTurns turns(skeleton.joints.size(), physics::Quat::Identity());
  std::string title;
  TableReader root(tree, "", context);
  root(Field{"title"}, title);
  readTable(root, "joints", [&](TableReader& reader) {
    for (size_t i = 0; i < turns.size(); ++i) {
      Vec3 degrees = Vec3::Zero();
      const std::string& child = skeleton.bones[skeleton.joints[i].child].name;
      reader(Field{child.c_str(), Unit::kNone, false, -360, 360}, degrees);
      turns[i] = turnOf(degrees);
    }
  });
  root.finish();
  return turns;
}

}  // namespace scenes
