// Chooses the command, and turns errors into exit codes.
#include "app/commands/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <new>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "app/base/build_info.h"
#include "app/base/console.h"
#include "app/base/interrupt.h"
#include "app/base/nearest.h"
#include "app/commands/commands.h"
#include "scenes/joined.h"

namespace app {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 a bug of dbd, 2 bad arguments or scene, 3 a check failed,\n"
    "4 the environment (disk, permissions, ffmpeg), 130 interrupted (run it again to go on).\n"
    "DBD_HOME names the folder that holds scenes/ and assets/, where they are not found.\n";

std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& all) {
  const std::string nearest = nearestWord(word, known);
  if (!nearest.empty()) return fmt::format("did you mean '{}'?", nearest);
  return fmt::format("{} {}", all, scenes::joined(known, ", "));
}

// The first command or option of these arguments that there is not, and the nearest; empty: none.
std::string unknownWord(const CLI::App& line, std::span<const char* const> arguments) {
  const CLI::App* command = &line;
  for (const char* argument : arguments) {
    const std::string word = argument, of = command == &line ? "" : command->get_name() + ": ";
    std::vector<std::string> commands;
    for (const CLI::App* next : command->get_subcommands({})) commands.push_back(next->get_name());
    if (word.starts_with("--") && word.size() > 2) {
      const std::string option = word.substr(0, word.find('='));
      const std::vector<std::string> known = longNames(*command);
      if (std::find(known.begin(), known.end(), option) != known.end()) continue;
      return fmt::format("{}no option '{}'; {}", of, option,
                         suggestion(option, known, "its options are"));
    }
    if (commands.empty() || word.starts_with("-")) continue;
    if (std::find(commands.begin(), commands.end(), word) == commands.end()) {
      return fmt::format("{}no command '{}'; {}", of, word,
                         suggestion(word, commands, "the commands are"));
    }
    command = command->get_subcommand(word);
  }
  return "";
}

ExitCode chooseAndRun(int argc, const char* const* argv) {
  CLI::App line("Displacement based dynamics: scenes in, measured motion and pictures out.", "dbd");
  line.require_subcommand(1);
  line.set_version_flag("--version", "dbd " + version());
  line.footer(kFooter);
  Action action;
  addList(line, action);
  addPlan(line, action);
  addSimulate(line, action);
  addRender(line, action);
  addFigures(line, action);
  addStudy(line, action);
  addTrust(line, action);
  addDiverge(line, action);
  addRace(line, action);
  addGolden(line, action);
  addCompare(line, action);
  addCheck(line, action);
  addConvert(line, action);
  addDoctor(line, action);
  addGallery(line, action);
  addWords(line, action);
  addCompletion(line, action);
  const std::span arguments(argv + 1, static_cast<std::size_t>(std::max(argc - 1, 0)));
  try {
    line.parse(argc, argv);
  } catch (const CLI::Success& help) {  // --help, --version
    std::ostringstream text;
    line.exit(help, text, text);
    say(text.str());
    return ExitCode::kDone;
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknownWord(line, arguments);
    if (!unknown.empty()) throw scenes::InputError(unknown);
    throw scenes::InputError(
        fmt::format("{}\nRun 'dbd --help' or 'dbd COMMAND --help'.", error.what()));
  }
  return action();
}

}  // namespace

ExitCode runCommandLine(int argc, const char* const* argv) {
  const auto fail = [](const char* what, ExitCode code) {
    note(fmt::format("dbd: {}\n", what));
    return code;
  };
  try {
    const ExitCode code = chooseAndRun(argc, argv);
    flushOutput();
    return code;
  } catch (const scenes::InputError& error) {
    return fail(error.what(), ExitCode::kBadInput);
  } catch (const ReaderGone&) {
    return ExitCode::kEnvironment;
  } catch (const EnvironmentError& error) {
    return fail(error.what(), ExitCode::kEnvironment);
  } catch (const CheckFailed& error) {
    return fail(error.what(), ExitCode::kCheckFailed);
  } catch (const std::system_error& error) {
    return fail(error.what(), ExitCode::kEnvironment);
  } catch (const std::bad_alloc&) {
    return fail("out of memory", ExitCode::kEnvironment);
  } catch (const std::exception& error) {
    return fail(fmt::format("this is a bug of dbd, please report it: {}", error.what()).c_str(),
                ExitCode::kBug);
  }
}

}  // namespace app
