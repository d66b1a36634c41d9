// posix_spawn with a socket as standard input: a socket, unlike a pipe, can be written to without
// a SIGPIPE when the child has gone.
#include "render/child.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

extern char** environ;

namespace render {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(int error, const char* what) {
  throw std::system_error(error, std::generic_category(), what);
}

File makeTemporary() {
  File file(std::tmpfile(), std::fclose);
  if (!file) fail(errno, "cannot make a temporary file");
  ::fcntl(::fileno(file.get()), F_SETFD, FD_CLOEXEC);
  return file;
}

std::string contents(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;)
    text.append(buffer, n);
  return text;
}

struct Sockets {
  int ours = -1, theirs = -1;
  Sockets() {
    int pair[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
      fail(errno, "cannot make a socket pair");
    ours = pair[0];
    theirs = pair[1];
  }
  ~Sockets() {
    closeOurs();
    closeTheirs();
  }
  void closeOurs() { closeOne(ours); }
  void closeTheirs() { closeOne(theirs); }

 private:
  static void closeOne(int& descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
  }
};

// 0, or the error that posix_spawnp gave.
int spawn(const std::vector<std::string>& arguments, int input, int output, int errors,
          pid_t& child) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  const int error = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

bool sendAll(int socket, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t sent = ::send(socket, data, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    data += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

int waitFor(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail(errno, "cannot wait for a child");
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ChildResult runChild(const std::vector<std::string>& arguments,
                     const std::function<void(const Feed&)>& write) {
  const File output = makeTemporary(), errors = makeTemporary();
  Sockets input;
  pid_t child = 0;
  const int error =
      spawn(arguments, input.theirs, ::fileno(output.get()), ::fileno(errors.get()), child);
  ChildResult result;
  if (error == ENOENT || error == EACCES || error == ENOTDIR) return result;
  if (error != 0) fail(error, "cannot start a child");
  result.started = true;
  input.closeTheirs();
  try {
    if (write)
      write([&](const char* data, std::size_t size) {
        return result.inputTaken = result.inputTaken && sendAll(input.ours, data, size);
      });
  } catch (...) {
    input.closeOurs();
    waitFor(child);
    throw;
  }
  input.closeOurs();
  result.exitCode = waitFor(child);
  result.output = contents(output.get());
  result.errors = contents(errors.get());
  return result;
}

}  // namespace render
