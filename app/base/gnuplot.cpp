// Runs gnuplot on a script in an output folder.
#include "app/base/gnuplot.h"

#include <fmt/format.h>

#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/commands/exit_code.h"
#include "render/child.h"

namespace app {

const char* const kNoGnuplot =
    "dbd: no diagrams: cannot run gnuplot; install it with: sudo apt-get install -y "
    "gnuplot-nox, and run this again\n";

std::string gnuplotVersion() {
  const render::ChildResult result = render::runChild({"gnuplot", "--version"});
  if (!result.started || result.exitCode != 0) return "";
  return result.output.substr(0, result.output.find('\n'));
}

void runGnuplot(const std::string& script, const std::filesystem::path& folder,
                const std::string& name) {
  const std::filesystem::path file = folder / (name + ".gp");
  writeFile(file, script);
  const std::string move = fmt::format("cd '{}'", std::filesystem::absolute(folder).string());
  const render::ChildResult result =
      render::runChild({"gnuplot", "-e", move, std::filesystem::absolute(file).string()});
  if (!result.started) {
    throw EnvironmentError(
        "cannot run gnuplot; install it with: sudo apt-get install -y gnuplot-nox");
  }
  if (result.exitCode != 0 && !interrupted()) {
    throw EnvironmentError(fmt::format("gnuplot {}: {}", file.string(), result.errors));
  }
}

}  // namespace app
