// How a command ends, and the errors that say so from deep inside.
#pragma once

#include <stdexcept>

namespace app {

enum class ExitCode {
  kDone = 0,
  kBug = 1,
  kBadInput = 2,     // arguments or scene
  kCheckFailed = 3,  // an expectation, a golden image, or numbers that stopped being finite
  kEnvironment = 4,  // no disk space, no permission, no ffmpeg, no OpenGL
  kInterrupted = 130,
};

// The machine, not the user, stood in the way.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Who reads the output has enough, as `head` after its lines: the program ends without a word.
class ReaderGone : public EnvironmentError {
 public:
  using EnvironmentError::EnvironmentError;
};

// A result is not what it has to be, and the command cannot go on.
class CheckFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace app
