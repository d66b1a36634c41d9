// Motion capture files (BVH): a tree of joints, and how each is turned in each frame.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "physics/base/types.h"

namespace scenes {

// Of the file's channels: moved along x, y, z, or turned about them.
enum class BvhChannel : char { kMoveX, kMoveY, kMoveZ, kTurnX, kTurnY, kTurnZ };

struct BvhJoint {
  std::string name;                              // empty: an end site
  int parent = -1;                               // of the list; parents stand before their children
  physics::Vec3 offset = physics::Vec3::Zero();  // from the parent at rest, in the file's unit
  std::vector<BvhChannel> channels;              // as they follow each other in a frame
};

struct Bvh {
  std::vector<BvhJoint> joints;             // the first is the root
  double frameTime = 0;                     // s
  std::vector<std::vector<double>> frames;  // a number for each channel: file's unit, degrees

  int find(const std::string& name) const;        // -1: none
  std::vector<physics::Vec3> restPoints() const;  // of joints, from the root
  // By joint, from rest: how it and all below it are turned in a frame.
  std::vector<physics::Quat> turns(std::size_t frame) const;
  physics::Vec3 rootAt(std::size_t frame) const;  // the file's unit
};

// Throws InputError("path:line: expected ...").
Bvh parseBvh(const std::string& text, const std::string& path);

}  // namespace scenes
