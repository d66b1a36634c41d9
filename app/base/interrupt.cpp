// Ctrl-C and SIGTERM become a question that loops ask, and an end where none asks in time.
#include "app/base/interrupt.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstring>

#include "app/commands/exit_code.h"

namespace app {

namespace {

volatile sig_atomic_t asked = 0;

constexpr long kPatience = 800'000'000;  // ns: seen within a second, with some to spare
timer_t timer;
bool hasTimer = false;

// Paths that a signal handler can read: nothing here is ever freed.
constexpr int kSlots = 16;
struct Slot {
  enum State { kFree, kTaken, kHeld };
  std::atomic<int> state{kFree};
  char path[PATH_MAX] = {};
};
Slot slots[kSlots];

// Only calls that POSIX allows in signal handlers.
void remember(int) {
  asked = 1;
  if (!hasTimer) return;
  const itimerspec once = {{0, 0}, {0, kPatience}};
  timer_settime(timer, 0, &once, nullptr);
}

void endHere(int) {
  for (const Slot& slot : slots) {
    if (slot.state == Slot::kHeld) unlink(slot.path);
  }
  constexpr char kTold[] =
      "\ndbd: interrupted in the middle of a frame; files that were whole are kept\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kTold, sizeof kTold - 1);
  _exit(static_cast<int>(ExitCode::kInterrupted));
}

void watch(int signal, void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void watchInterrupts() {
  struct sigevent event = {};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  hasTimer = timer_create(CLOCK_MONOTONIC, &event, &timer) == 0;
  watch(SIGALRM, endHere, SA_RESTART);
  watch(SIGINT, remember, static_cast<int>(SA_RESETHAND | SA_RESTART));
  watch(SIGTERM, remember, static_cast<int>(SA_RESETHAND | SA_RESTART));
}

bool interrupted() { return asked != 0; }

RemovedOnInterrupt::RemovedOnInterrupt(const std::string& path) {
  if (path.size() >= PATH_MAX) return;
  for (int i = 0; i < kSlots && slot_ < 0; ++i) {
    int free = Slot::kFree;
    if (slots[i].state.compare_exchange_strong(free, Slot::kTaken)) slot_ = i;
  }
  if (slot_ < 0) return;
  std::memcpy(slots[slot_].path, path.c_str(), path.size() + 1);
  slots[slot_].state = Slot::kHeld;
}

RemovedOnInterrupt::~RemovedOnInterrupt() {
  if (slot_ >= 0) slots[slot_].state = Slot::kFree;
}

}  // namespace app
