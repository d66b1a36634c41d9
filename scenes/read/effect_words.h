// Which words of a scene file make an effect, and so take it out.
#pragma once

#include <string>
#include <vector>

#include "scenes/effects.h"
#include "scenes/measure/survey.h"

namespace scenes {

// Why there are no constraints of a kind: "no [[spring]]".
std::string whyNone(const std::string& kind);

// What takes a kind out of the scene, or why it stays.
void takeOut(const Survey& survey, const Made& made, Effect& effect);

// No "friction", or "restitution", anywhere, whoever asked for it.
std::vector<std::string> withoutSurface(const Survey& survey, const std::string& key);

}  // namespace scenes
