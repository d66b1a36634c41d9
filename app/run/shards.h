// A film drawn by many runs, on one machine or on many that see one folder: shard k of n draws
// every n-th frame from the k-th into DIR/jobs/k-of-n, and collecting joins what is whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/run/render_run.h"

namespace app {

struct Shard {
  int index = 0, count = 1;
};

// Of ascending frames a step apart, as --frames takes it: "3:596:8". There are at least as many
// frames as shards.
std::string framesOf(const Shard& shard, const std::vector<int>& frames);
std::filesystem::path folderOf(const Shard& shard, const std::filesystem::path& folder);

struct Collected {
  RenderResult result;
  std::vector<Shard> missing;  // those that have frames to draw yet
};

// Draws and steps nothing. Throws InputError where no job has written here or one is of another
// run, CheckFailed where two jobs came to different states of a frame.
Collected collectFrames(const scenes::Scene& scene, const RenderJob& job);

}  // namespace app
