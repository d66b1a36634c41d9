// A run as glTF 2.0 with its animation, for Blender, game engines and viewers.
#pragma once

#include <string>

#include "app/take/take.h"

namespace app {

// A node for each body with a track of its place and turn, cloths and soft bodies as morph targets,
// a frame each; y up, metres, seconds. Contacts and the like have no place in it. `binary`: .glb,
// else .gltf with its numbers inside.
std::string gltfFile(const Take& take, const scenes::Scene& scene, bool binary);

}  // namespace app
