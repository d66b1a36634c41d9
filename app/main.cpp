// dbd: displacement based dynamics.
#include <cstdio>
#include <cstdlib>

#include "app/base/console.h"
#include "app/base/interrupt.h"
#include "app/commands/command_line.h"

int main(int argc, char** argv) {
  app::guardStandardStreams();
  app::watchInterrupts();
  // Each renderer draws on its own thread; Mesa's would only compete with them. Read by Mesa when
  // the first context is made.
  setenv("LP_NUM_THREADS", "0", 1);
  const app::ExitCode code = app::runCommandLine(argc, argv);
  std::fflush(stdout);
  return static_cast<int>(code);
}
