// Chooses the command, and turns errors into exit codes.
#include "app/commands/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "app/base/build_info.h"
#include "app/base/console.h"
#include "app/base/interrupt.h"
#include "app/base/nearest.h"
#include "app/commands/commands.h"

namespace app {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 a bug of dbd, 2 bad arguments or scene, 3 a check failed,\n"
    "4 the environment (disk, permissions, ffmpeg), 130 interrupted (run it again to go on).\n"
    "DBD_HOME names the folder that holds scenes/ and assets/, where they are not found.\n";

// An unknown command is told before the parser sees it: it would only say that one is required.
void requireKnownCommand(const CLI::App& line, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> known;
  for (const CLI::App* command : line.get_subcommands({})) known.push_back(command->get_name());
  const std::string word = argv[1];
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  const std::string nearest = nearestWord(word, known);
  throw scenes::InputError(
      fmt::format("no command '{}'; {}", word,
                  nearest.empty() ? fmt::format("the commands are {}", fmt::join(known, ", "))
                                  : fmt::format("did you mean '{}'?", nearest)));
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
  addDoctor(line, action);
  addGallery(line, action);
  addWords(line, action);
  requireKnownCommand(line, argc, argv);
  try {
    line.parse(argc, argv);
  } catch (const CLI::Success& help) {  // --help, --version
    std::ostringstream text;
    line.exit(help, text, text);
    say(text.str());
    return ExitCode::kDone;
  } catch (const CLI::ParseError& error) {
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
