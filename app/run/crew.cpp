// A socket of packets to each worker: a task there, an answer back. The first letter of an answer
// tells whether it is one or what was thrown.
#include "app/run/crew.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "app/base/interrupt.h"
#include "app/commands/exit_code.h"

namespace app {

namespace {

constexpr char kDone = 'd', kEnvironment = 'e', kFailed = 'f', kBug = 'b', kDropped = 'x';
constexpr int kPatience = 50;  // ms until it is asked again whether a signal came

[[noreturn]] void failStart(const char* what) {
  throw EnvironmentError(
      fmt::format("cannot {} a drawing process: {}", what, std::strerror(errno)));
}

bool send(int socket, const std::string& packet) {
  while (::send(socket, packet.data(), packet.size(), MSG_NOSIGNAL) < 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

// Empty: the other side has gone.
std::string receive(int socket) {
  char none = 0;
  ssize_t size = 0;
  do {
    size = ::recv(socket, &none, 1, MSG_PEEK | MSG_TRUNC);
  } while (size < 0 && errno == EINTR);
  if (size <= 0) return "";
  std::string packet(static_cast<std::size_t>(size), '\0');
  return ::recv(socket, packet.data(), packet.size(), 0) == size ? packet : "";
}

std::string answer(const Crew::Work& work, const std::string& task) {
  if (interrupted()) return {kDropped};
  try {
    return kDone + work(task);
  } catch (const EnvironmentError& error) {
    return kEnvironment + std::string(error.what());
  } catch (const CheckFailed& error) {
    return kFailed + std::string(error.what());
  } catch (const std::system_error& error) {
    return kEnvironment + std::string(error.what());
  } catch (const std::exception& error) {
    return kBug + std::string(error.what());
  }
}

// Ends without destructors: what they would clean up is the caller's.
[[noreturn]] void serve(int socket, const Crew::Work& work) {
  for (std::string task = receive(socket); !task.empty(); task = receive(socket)) {
    if (!send(socket, answer(work, task))) break;
  }
  ::_exit(0);
}

}  // namespace

Crew::Crew(int workers, const Work& work, Take take) : take_(std::move(take)) {
  for (int i = 0; i < workers; ++i) start(work);
}

void Crew::start(const Work& work) {
  int pair[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair) != 0) failStart("reach");
  const pid_t caller = ::getpid(), process = ::fork();
  if (process < 0) {
    ::close(pair[0]);
    ::close(pair[1]);
    if (workers_.empty()) failStart("start");
    return;  // fewer will do
  }
  if (process == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody is left who wants what it would write
    if (::getppid() != caller) ::_exit(0);
    ::close(pair[0]);
    for (const Worker& other : workers_) ::close(other.socket);
    serve(pair[1], work);
  }
  ::close(pair[1]);
  workers_.push_back({process, pair[0], {}});
}

Crew::~Crew() {
  for (const Worker& worker : workers_) {
    if (worker.process < 0) continue;
    ::close(worker.socket);
    if (!worker.jobs.empty()) ::kill(worker.process, SIGTERM);
  }
  for (const Worker& worker : workers_) {
    while (worker.process > 0 && ::waitpid(worker.process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

void Crew::ask(int job, std::string task) {
  tasks_.push_back({job, std::move(task)});
  hire();
}

// The next task goes to who has the least in hand.
void Crew::hire() {
  while (!tasks_.empty() && !failure_) {
    const auto worker = std::min_element(
        workers_.begin(), workers_.end(),
        [](const Worker& a, const Worker& b) { return a.jobs.size() < b.jobs.size(); });
    if (worker->jobs.size() >= kInHand) return;
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    worker->jobs.push_back(task.job);
    if (!send(worker->socket, task.text)) failCrashed(*worker);
  }
}

void Crew::pump() {
  wait(0);
  hire();
  if (failure_) finish();
}

bool Crew::finish() {
  while (isBusy() && !interrupted()) {
    wait(kPatience);
    hire();
  }
  if (isBusy() || (failure_ && interrupted())) return false;
  throwFailure();
  return true;
}

void Crew::abandon() {
  tasks_.clear();
  for (const Worker& worker : workers_) {
    if (!worker.jobs.empty()) ::kill(worker.process, SIGTERM);  // which drops what it has not begun
  }
  while (isBusy()) wait(kPatience);
}

bool Crew::isBusy() const {
  return !tasks_.empty() || std::any_of(workers_.begin(), workers_.end(),
                                        [](const Worker& w) { return !w.jobs.empty(); });
}

void Crew::wait(int milliseconds) {
  std::vector<pollfd> sockets;
  for (const Worker& worker : workers_) sockets.push_back({worker.socket, POLLIN, 0});
  if (::poll(sockets.data(), sockets.size(), milliseconds) <= 0) return;
  for (std::size_t i = 0; i < sockets.size(); ++i) {
    if (sockets[i].revents != 0) takeAnswer(workers_[i]);
  }
}

void Crew::takeAnswer(Worker& worker) {
  const std::string packet = receive(worker.socket);
  if (packet.empty() || worker.jobs.empty()) return failCrashed(worker);
  const int job = worker.jobs.front();
  worker.jobs.pop_front();
  if (packet[0] == kDone) return take_(job, packet.substr(1));
  fail({job, packet[0], packet.substr(1)});
}

// It is left with a socket of -1, which poll() passes over.
void Crew::failCrashed(Worker& worker) {
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  const std::string end = WIFSIGNALED(status) ? fmt::format("signal {}, {}", WTERMSIG(status),
                                                            ::strsignal(WTERMSIG(status)))
                                              : fmt::format("code {}", WEXITSTATUS(status));
  ::close(worker.socket);
  const int job = worker.jobs.empty() ? -1 : worker.jobs.front();
  worker = {};
  fail({job, kEnvironment,
        fmt::format("the process that drew frame {} ended with {}; whole frames are kept", job,
                    end)});
}

// Nothing more is begun; what is in work may still tell of an earlier job.
void Crew::fail(Failure failure) {
  tasks_.clear();
  if (!failure_ || failure.job < failure_->job) failure_ = std::move(failure);
}

void Crew::throwFailure() const {
  if (!failure_) return;
  switch (failure_->kind) {
    case kEnvironment:
      throw EnvironmentError(failure_->text);
    case kFailed:
      throw CheckFailed(failure_->text);
    case kDropped:
      throw EnvironmentError(
          fmt::format("the process that was to draw frame {} was told to end", failure_->job));
    default:
      throw std::runtime_error(failure_->text);
  }
}

}  // namespace app
