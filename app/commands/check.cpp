// dbd check: runs the expectations that scenes state about themselves.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/junit.h"
#include "app/base/output_file.h"
#include "app/commands/commands.h"
#include "app/run/play.h"
#include "app/run/run_record.h"

namespace app {

namespace {

struct CheckOptions {
  CommonOptions common;
  std::vector<std::string> scenes;
  bool all = false;
  std::string junit;
};

std::string verdictTable(const scenes::Scene& scene,
                         const std::vector<scenes::Checker::Verdict>& verdicts,
                         const PlayEnd& end) {
  std::string table, stopped;
  if (end.frames < scene.frameCount()) {
    stopped =
        fmt::format("; the run stopped at frame {} of {}", end.frames - 1, scene.frameCount() - 1);
  }
  for (const scenes::Checker::Verdict& verdict : verdicts) {
    table +=
        fmt::format("{:<5} {:<18} {}", verdict.holds ? "ok" : "FAIL", scene.name, verdict.text);
    table += fmt::format("  (at {:.4g} s; {}:{}{})\n", verdict.atTime,
                         std::filesystem::path(scene.path).filename().string(),
                         verdict.expectation.line, stopped);
  }
  if (verdicts.empty()) table = fmt::format("none  {:<18} states no expectation\n", scene.name);
  return table;
}

// What a run of one scene came to, and of how many expectations.
struct Checked {
  ExitCode code = ExitCode::kDone;
  std::size_t expectations = 0;
  std::vector<JunitCase> cases{};
};

std::vector<JunitCase> casesOf(const scenes::Scene& scene,
                               const std::vector<scenes::Checker::Verdict>& verdicts) {
  std::vector<JunitCase> cases;
  for (const scenes::Checker::Verdict& verdict : verdicts) {
    const std::string name =
        fmt::format("{} (line {})", verdict.expectation.metric, verdict.expectation.line);
    cases.push_back(
        {scene.name, name, verdict.holds ? "" : verdict.text, verdict.holds ? verdict.text : ""});
  }
  return cases;
}

Checked checkScene(const CheckOptions& options, const std::string& name) {
  const scenes::Scene scene = scenes::readScene(name, options.common.overrides);
  scenes::Simulation simulation(scene);
  scenes::Checker checker(scene);
  Progress progress(options.common.progressMode(), scene.name, "checking", scene.frameCount());
  RunRecord record = makeRecord(scene);
  noteWarnings(record);
  const PlayEnd end = play(simulation, scene.frameCount(), [&](double) {
    checker.observe(simulation);
    record.stateHashes.push_back(hexadecimal(simulation.stateHash()));
    progress.advance();
  });
  if (end.code == ExitCode::kInterrupted) return {end.code, 0};
  progress.finish();
  if (!simulation.isFinite()) checker.observe(simulation);  // `finite` does not hold
  const std::vector<scenes::Checker::Verdict> verdicts = checker.verdicts();
  if (!options.common.quiet) say(verdictTable(scene, verdicts, end));
  if (!end.problem.empty()) note("dbd: " + end.problem + "\n");
  if (options.common.hash) say(record.stateHashes.back() + "\n");
  if (!options.common.folder.empty()) {
    record.expectations = describeVerdicts(verdicts);
    record.finished = end.code == ExitCode::kDone;
    writeRecord(record, std::filesystem::path(options.common.folder) / scene.name);
  }
  flushOutput();
  const bool holds = std::all_of(verdicts.begin(), verdicts.end(),
                                 [](const auto& verdict) { return verdict.holds; });
  return {holds ? end.code : ExitCode::kCheckFailed, verdicts.size(), casesOf(scene, verdicts)};
}

ExitCode check(const CheckOptions& options) {
  const std::vector<std::string> names = options.all ? wholeLibrary() : options.scenes;
  if (names.empty()) throw scenes::InputError("check: name a scene, or --all");
  if (!options.common.folder.empty()) {
    requireOwnNames(names, "check", options.common.folder,
                    "check them one by one, with another --out for each");
  }
  Checked all;
  for (const std::string& name : names) {
    const Checked one = checkScene(options, name);
    if (one.code == ExitCode::kInterrupted) return one.code;
    if (one.code != ExitCode::kDone) all.code = one.code;
    all.expectations += one.expectations;
    all.cases.insert(all.cases.end(), one.cases.begin(), one.cases.end());
  }
  writeJunit(options.junit, "dbd check", all.cases);
  if (all.expectations == 0)
    throw CheckFailed("check: nothing was checked, there is no [[expect]]");
  return all.code;
}

}  // namespace

void addCheck(CLI::App& line, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = line.add_subcommand(
      "check", "Run the [[expect]] of scenes; exit code 3 when one does not hold");
  command->add_option("SCENE", options->scenes, "Scenes of the library or .toml files");
  command->add_flag("--all", options->all, "Every scene of the library")->excludes("SCENE");
  command->add_option("--junit", options->junit, "Also write the results as JUnit's XML")
      ->type_name("F.xml");
  addCommon(*command, options->common);
  addHash(*command, options->common);
  command->get_option("--out")->description("Also write DIR/NAME/run.json with the verdicts");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace app
