// A body, and a pair of bodies, as the collider knows them from one look to the next.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "physics/bodies/compound.h"
#include "physics/collision/collider.h"
#include "physics/collision/solid.h"

namespace physics::collision {

// A body, or a part of one, as the collider knows it, with its motion in the present step. What is
// read for most pairs comes first, in a line of the cache.
struct alignas(64) Item {
  double travel = 0;  // length of the way of its points so far, at most [m]
  double turn = 0;    // the furthest that turning moves a point of the core in this step [m]
  double push = 0;    // how much further hits may take it in this step [m]
  Vec3 move = Vec3::Zero();
  BodyId body = 0;
  bool movable = false;
  bool rests = false;  // stands still until it is woken
  bool isPlane = false;
  bool isPart = false;    // it is somewhere else in its body: `inBody`
  Vec3 x = Vec3::Zero();  // at the start
  Mat3 R = Mat3::Identity();
  Solid solid;
  Pose inBody;

  Pose at(const Pose& ofBody) const { return isPart ? placed(ofBody, inBody) : ofBody; }
};

// Two items, and what is known of them since their last narrow phase. Plain numbers: watches are
// moved as bytes when pairs come and go.
struct Watch {
  int a = 0, b = 0;
  int finding = 0;         // what was found is kept there
  std::uint8_t count = 0;  // of the points found then
  bool known = false;
  bool isNew = false;         // it was the last look
  std::uint8_t more = 0;      // manifolds beside the first: with meshes
  std::uint8_t calls = 0;     // narrow-phase evaluations of the last look
  double travel = 0;          // of both items together, then
  double distance = 0;        // then, or a lower bound
  double reach = 0;           // how far was looked
  std::array<double, 3> n{};  // b's frame: without points, they are `distance` apart along it

  Vec3 normal() const { return {n[0], n[1], n[2]}; }
  void setNormal(const Vec3& normal) { n = {normal.x(), normal.y(), normal.z()}; }
  std::pair<int, int> items() const { return {a, b}; }
};
static_assert(std::is_trivially_copyable_v<Watch>);
struct Finding {
  Relative pose;
  Manifold manifold;
  std::vector<Manifold> more;  // of a mesh that is touched from several sides
};

}  // namespace physics::collision
