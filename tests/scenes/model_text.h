// Short models for tests.
#pragma once

#include <string>

#include "scenes/simulation.h"

namespace scenes {

// Reads `text` as the file "m.xml".
inline Scene modelOf(const std::string& text) { return parseScene(text, "m.xml"); }

inline std::string modelError(const std::string& text) {
  try {
    modelOf(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// <mujoco> with this inside, on lines of its own.
inline std::string mujoco(const std::string& inside) {
  return "<mujoco>\n" + inside + "\n</mujoco>\n";
}

// In a <worldbody>.
inline std::string world(const std::string& inside) {
  return mujoco("<worldbody>\n" + inside + "\n</worldbody>");
}

inline physics::Pose poseOf(const Simulation& simulation, const std::string& body) {
  return simulation.world().bodies().pose.at(static_cast<std::size_t>(simulation.findBody(body)));
}

// What a model with Z up has at `point`, where Y is up.
inline physics::Vec3 yUp(double x, double y, double z) { return {x, z, -y}; }

}  // namespace scenes
