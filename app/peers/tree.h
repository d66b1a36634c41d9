// The trees that joints make of bodies, parents first: what a method in joint coordinates needs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/peers/blueprint.h"
#include "app/peers/peer.h"

namespace app {

struct TreeLink {
  physics::BodyId body = 0;
  physics::BodyId parentBody = 0;
  int parent = -1;                   // index of its link; -1: the base
  const PeerJoint* joint = nullptr;  // of the Blueprint
  int side = 0;                      // of the joint that is this body's
};

struct Tree {
  physics::BodyId base = 0;
  bool isFixed = false;  // the base is a static body, which the tree does not own
  std::vector<TreeLink> links;
  // Of points on rods: the normal of the plane in which they stay.
  std::optional<physics::Vec3> plane;
};

struct Forest {
  std::vector<Tree> trees;
  std::string refusal;
};

// Joint coordinates hold no joint that is open or opens: such a start would be another one.
bool startsAsGiven(const Peer& peer, const physics::Bodies& bodies);

Forest findTrees(const physics::World& world, const Blueprint& plan);

}  // namespace app
