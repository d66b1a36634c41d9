// The effects there are, in one ordered table: which of them a scene has on, and why.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace scenes {

enum class EffectPart { kMotion, kForces, kConstraints, kContacts, kSolution, kPictures };
const char* nameOf(EffectPart part);

struct Effect {
  std::string name;  // the scene's word, where there is one
  EffectPart part = EffectPart::kMotion;
  bool on = false;
  bool leftOut = false;    // off because it cannot matter here, whatever the scene's words are
  std::string why;         // "chain.toml:14: [gravity]", or the reason why it is off
  std::int64_t count = 0;  // of what it acts on
  std::string unit;        // "bodies", "pairs"
  std::int64_t rows = 0;   // of a constraint or force
  // What takes it out of the scene, each as of --set. None: it cannot be taken out, `stays` says
  // why.
  std::vector<std::string> without;
  std::string stays;
};

// All of them, those that are off included, in the order of the table. Builds the scene's world.
std::vector<Effect> effectsOf(const Scene& scene);

// Overrides that switch on what the program leaves out of a scene because it cannot matter or
// because nothing calls for it: what "everything on" means.
std::vector<std::string> everythingOn();

}  // namespace scenes
