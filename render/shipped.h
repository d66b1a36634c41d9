// What comes with dbd: scenes/ and assets/.
#pragma once

#include <filesystem>
#include <string>

namespace render {

// Beside the program, else where that is installed, else the tree that it was built in, else where
// it was to be installed.
std::filesystem::path shippedFolder();
std::string shippedFont();

}  // namespace render
