// Which frames: A:B:S as in Python, B exclusive; a single number is that frame alone.
#pragma once

#include <string>
#include <vector>

namespace app {

// Frames in 0..count-1, ascending. Negative A or B count from the end; parts may be left out.
// Throws InputError for anything else, a step below 1, and ranges without a frame.
std::vector<int> parseFrameRange(const std::string& text, int count);

std::string frameRangeText(const std::vector<int>& frames);  // as parseFrameRange() reads it

}  // namespace app
