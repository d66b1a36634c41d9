// The program that draws diagrams.
#pragma once

#include <filesystem>
#include <string>

namespace app {

// "gnuplot 5.4 patchlevel 4"; empty: it cannot be run.
std::string gnuplotVersion();

// What to say where it cannot.
extern const char* const kNoGnuplot;

// Writes FOLDER/NAME.gp and runs it there. Throws EnvironmentError with what gnuplot said.
void runGnuplot(const std::string& script, const std::filesystem::path& folder,
                const std::string& name);

}  // namespace app
