// A World in MuJoCo's words: MJCF, its bodies in trees of joints.
#pragma once

#include <string>

#include "app/peers/tree.h"

namespace app {

// The name of a body in the model.
std::string mujocoName(physics::BodyId body);

// Why MuJoCo cannot express the world; empty: it can.
std::string mujocoRefusal(const physics::World& world, const Blueprint& plan, const Forest& forest);

std::string mujocoModel(const physics::World& world, const Blueprint& plan, const Forest& forest);

}  // namespace app
