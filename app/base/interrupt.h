// Ctrl-C and SIGTERM become a question that loops ask, and an end where none asks in time.
#pragma once

#include <string>

namespace app {

// The first signal is remembered; the second one ends the program. Where the program is still there
// within a second of the first, in a long step or a long drawing, it ends as killed programs do:
// what is written stays, what is half written goes, and the exit code is 130.
void watchInterrupts();
bool interrupted();

// A file that an end in the middle removes, for as long as this lives.
class RemovedOnInterrupt {
 public:
  explicit RemovedOnInterrupt(const std::string& path);
  ~RemovedOnInterrupt();
  RemovedOnInterrupt(const RemovedOnInterrupt&) = delete;
  RemovedOnInterrupt& operator=(const RemovedOnInterrupt&) = delete;

 private:
  int slot_ = -1;  // -1: there is no room, and the file stays
};

}  // namespace app
