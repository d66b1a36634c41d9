// MJCF and URDF: files of other programs, as the words of scene files.
#pragma once

#include <string>
#include <vector>

#include "scenes/read/value.h"

namespace scenes {

bool isModelFile(const std::string& path);  // .xml, .mjcf or .urdf
// Of such a file, and not the words that it has become, as runs keep them.
bool isModel(const std::string& text, const std::string& path);

// `told` gets a line for each thing of the file that is not read. `keyframe`: the <key> of MJCF
// that it starts in; empty: none. Throws InputError.
Value readModel(const std::string& text, const std::string& path, std::vector<std::string>& told,
                const std::string& keyframe = "");

}  // namespace scenes
