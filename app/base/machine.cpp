// Asks the system what it runs on.
#include "app/base/machine.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace app {

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

int processorCount() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

double loadAverage() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

}  // namespace app
