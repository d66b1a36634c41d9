// What a picture and a film tell of how they were made, so that one that was found can be made
// again. The same for every way of making it: no folder, no number of threads, no time of day.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/run/run_record.h"
#include "render/png.h"

namespace app {

// The command that draws these frames: "dbd render chain --size 1280x720 --frames 17".
std::string commandOf(const RunRecord& record, const std::string& frames);

// Of another command about a scene, up to its overrides: "dbd race chain --set fps=30".
std::string commandOf(const std::string& word, const RunRecord& record);

render::PngNotes notesOf(const RunRecord& record, int frame);
render::PngNotes notesOf(const RunRecord& record, int frame, const std::string& command);

// Of the film of these frames: title, comment.
std::vector<std::array<std::string, 2>> filmNotes(const RunRecord& record);

}  // namespace app
