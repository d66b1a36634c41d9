// Ctrl-C and SIGTERM become a question that loops ask.
#pragma once

namespace app {

void watchInterrupts();  // the first signal is remembered, the second one ends the program
bool interrupted();

}  // namespace app
