// What a scene file abbreviates: other files, numbers with names, tables that repeat.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/read/read_value.h"

namespace scenes {

// include = "parts/car.toml", or several: their tables stand before the file's own; of a table that
// both have, the file's keys count. Paths are those of the including file. Models (MJCF, URDF) too;
// `told` gets what of them is not read. Returns their texts.
std::string includeFiles(Value& tree, const Context& context, std::vector<std::string>& told);

// "parameters.n=12" of `overrides` into [parameters]; returns the others. Throws InputError where
// there is no such parameter.
std::vector<std::string> setParameters(Value& tree, std::span<const std::string> overrides);

// [parameters], "= expressions", "{expressions}" in texts, and [[repeat]]: gone when this returns.
void expand(Value& tree, const Context& context);

}  // namespace scenes
