// Numbers as people read them, on pages and in lines of text.
#pragma once

#include <string>

namespace app {

std::string lengthText(double metres);  // "3.2 mm"
// A value beyond a limit, in three digits or as many as tell it from that: "1.004" of 1.
std::string textBeyond(double value, double limit);
std::string percentText(double share);       // "0.1 %"
std::string wholePercentText(double share);  // "12 %"; what rounds to nothing is "0 %"
std::string secondsText(double seconds);     // "1.3 ms"
std::string numberText(double value);        // "3.1e-05"
std::string levelText(double level);         // "1000", "0.49995", "3.2e5": no plus sign, no zeros

std::string superscript(std::string text);  // "m^2" -> "m²"

}  // namespace app
