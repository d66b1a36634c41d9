// The command line of dbd.
#pragma once

#include "app/commands/exit_code.h"

namespace app {

// Runs the command it names; an error becomes words for the user and an exit code.
ExitCode runCommandLine(int argc, const char* const* argv);

}  // namespace app
