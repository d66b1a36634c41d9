// What the machine is, and how busy.
#pragma once

#include <string>

namespace app {

std::string processorName();  // "AMD EPYC 7B13"; empty: not known
int processorCount();
double loadAverage();  // over the last minute; 0: not known

}  // namespace app
