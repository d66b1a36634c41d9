// Commands that a user, a job queue or a Makefile can run as they are printed.
#pragma once

#include <string>

namespace app {

std::string shellQuoted(const std::string& word);  // as it is where a shell takes nothing amiss
std::string programPath();                         // of this process; "dbd" where nobody knows

}  // namespace app
