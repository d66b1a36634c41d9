// Standard output for results, standard error for everything else.
#pragma once

#include <string_view>

namespace app {

// Gives the three standard streams a file when the caller closed them, so that no output file lands
// on their numbers, and turns a closed pipe into an error that can be told.
void guardStandardStreams();

void say(std::string_view text);  // to stdout; throws EnvironmentError when it cannot be written
void flushOutput();               // throws EnvironmentError when anything said could not be written
void note(std::string_view text);  // to stderr, at once; a closed stderr is no error

bool errorIsTerminal();

}  // namespace app
