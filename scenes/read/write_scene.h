// A scene as the text of one file, for records that outlive the files it was read from.
#pragma once

#include <string>

#include "scenes/read/value.h"
#include "scenes/scene.h"

namespace scenes {

// TOML with every override, included file, repeat and expression written out; parseScene() of it at
// the same path gives the same scene, and this text again. Without [golden], which is no part of a
// run, and without expectations of times that an override cut off.
std::string textOf(const Scene& scene);

// The words of a file in `folder`, or of a model that becomes one.
std::string tomlOf(const Value& tree, const std::string& folder);

}  // namespace scenes
