// What may happen to any text that is taken for a scene: it is read, built, stepped and looked at.
// The fuzz target and the test of mutated scenes share it.
#pragma once

#include <string>

#include "app/commands/exit_code.h"

namespace tests {

struct Tried {
  app::ExitCode code;
  std::string told;  // the error, where there is one
};

// Reads `text` as the file `path`. What it asks for in work is cut short, so that only reading,
// and not a long run that was asked for, can take long. Other exceptions than InputError pass.
// Scenes of more than `mostStepped` bodies are drawn, not stepped.
Tried tryScene(const std::string& text, const std::string& path, int mostStepped = 300);

// "path:12:3: ..." with a line and a column from 1.
bool hasPlace(const std::string& told, const std::string& path);

}  // namespace tests
