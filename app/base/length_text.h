// Lengths as people read them.
#pragma once

#include <string>

namespace app {

std::string lengthText(double metres);  // "3.2 mm"

}  // namespace app
