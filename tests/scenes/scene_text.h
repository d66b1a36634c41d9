// Short scenes for tests, and the errors that they give.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace scenes {

// Reads `text` as the file "test.toml".
Scene sceneOf(const std::string& text, const std::vector<std::string>& overrides = {});

// The message of the InputError that reading gives; "no error" where there is none.
std::string errorOf(const std::string& text, const std::vector<std::string>& overrides = {});

// A [[body]] of 1 kg with this name; three lines.
std::string ball(const std::string& name);

}  // namespace scenes
