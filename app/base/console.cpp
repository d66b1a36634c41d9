// Standard output for results, standard error for everything else.
#include "app/base/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "app/commands/exit_code.h"

namespace app {

namespace {

[[noreturn]] void failOutput(int error) {
  if (error == EPIPE) throw ReaderGone(std::strerror(error));
  throw EnvironmentError(std::string("standard output: ") + std::strerror(error));
}

}  // namespace

void guardStandardStreams() {
  // Opened the wrong way round on purpose: writing to a closed stdout must stay an error.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1) continue;
    const int opened = open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (opened != stream && opened >= 0) close(opened);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is told as a full disk is
}

void say(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) failOutput(errno);
}

void flushOutput() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) failOutput(errno != 0 ? errno : EIO);
}

void note(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

bool errorIsTerminal() { return isatty(STDERR_FILENO) != 0; }

}  // namespace app
