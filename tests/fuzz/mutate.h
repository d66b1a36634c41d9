// Scenes with mistakes in them, from a seed.
#pragma once

#include <string>
#include <vector>

namespace tests {

// One of the scenes with one to three mutations: bytes, lines, numbers, keys, nesting, encodings.
// The same seed gives the same text.
std::string mutated(const std::vector<std::string>& scenes, int seed);

}  // namespace tests
