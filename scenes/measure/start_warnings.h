// What a scene starts with that its author can hardly have meant.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace scenes {

// A sentence each, none where nothing is odd:
// bodies that overlap at the start by more than a tenth of how thick the thinner one is.
std::vector<std::string> startWarnings(const Scene& scene);

}  // namespace scenes
