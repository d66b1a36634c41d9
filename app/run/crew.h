// Processes that do the same kind of work side by side on what they are sent. Processes, since
// threads that draw with llvmpipe wait for each other: all contexts of a process share one screen.
#pragma once

#include <sys/types.h>

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace app {

class Crew {
 public:
  using Work = std::function<std::string(const std::string& task)>;      // in a worker
  using Take = std::function<void(int job, const std::string& answer)>;  // of the caller

  // Forks: a worker has what the caller has now, and nothing of what it makes later. To be called
  // while the program has one thread and no graphics context. Throws EnvironmentError.
  Crew(int workers, const Work& work, Take take);
  ~Crew();  // drops what is not done
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  // The worker that is free first will do it, in the order of asking; never waits. `job` is what
  // errors name, as "frame 17".
  void ask(int job, std::string task);

  // Hands out work and takes answers, as far as there are any. What a worker threw,
  // EnvironmentError or CheckFailed, is thrown here, of the first such job, when no more are in
  // work; a worker that crashed is an EnvironmentError with its job.
  void pump();
  bool finish();   // pumps until all is done; false: a signal came before
  void abandon();  // drops what no worker has begun, waits for the rest

 private:
  static constexpr std::size_t kInHand = 2;  // one is done while the other waits for it
  struct Worker {
    pid_t process = -1;
    int socket = -1;
    std::deque<int> jobs;  // that it was sent and has not answered
  };
  struct Task {
    int job = 0;
    std::string text;
  };
  struct Failure {
    int job = 0;
    char kind = 0;
    std::string text;
  };
  void start(const Work& work);
  void hire();
  void wait(int milliseconds);
  void takeAnswer(Worker& worker);
  void failCrashed(Worker& worker);
  void fail(Failure failure);
  void throwFailure() const;
  bool isBusy() const;

  Take take_;
  std::vector<Worker> workers_;
  std::deque<Task> tasks_;
  std::optional<Failure> failure_;  // the first by its job
};

}  // namespace app
