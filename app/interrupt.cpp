// Ctrl-C and SIGTERM become a question that loops ask.
#include "app/interrupt.h"

#include <signal.h>

namespace app {

namespace {

volatile sig_atomic_t asked = 0;

void remember(int) { asked = 1; }

}  // namespace

void watchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return asked != 0; }

}  // namespace app
