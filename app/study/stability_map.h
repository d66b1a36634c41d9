// The stability map of a family: how far each of its cases can be pushed, a bar for each method.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/study/stability_study.h"

namespace app {

// A script for gnuplot that writes NAME.svg and NAME.png where it is run. Cases without bars are
// left out; empty: there is none.
std::string mapScript(const std::vector<const StabilityResult*>& cases, const std::string& title,
                      const std::string& name);

// "1000", "0.49995", "3.2e5": no plus sign, no zeros in the power.
std::string levelText(double level);

// "at 3.7e5: joint_error, ball_socket 19, frame 34"
std::string borderText(const StabilityBar& bar);

// What fails first and where, in few words: "joint_error, ball_socket 19, frame 34".
std::string failureText(const StabilityRun& run);

}  // namespace app
