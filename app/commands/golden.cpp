// dbd golden: compares the pictures of the library with those that were approved, or approves them
// anew.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <memory>
#include <string_view>

#include "app/base/console.h"
#include "app/base/image_report.h"
#include "app/base/interrupt.h"
#include "app/base/junit.h"
#include "app/base/output_file.h"
#include "app/commands/commands.h"
#include "app/golden/golden_set.h"
#include "render/png.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct GoldenOptions {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string goldens, reason, junit;
  bool strict = false;
  int repeat = 1;
};

fs::path goldenFolder(const GoldenOptions& options) {
  const fs::path root = options.goldens.empty()
                            ? fs::path(scenes::libraryFolder()) / ".." / ".." / "tests" / "golden"
                            : fs::path(options.goldens);
  return root.lexically_normal();
}

std::vector<std::string> chosenScenes(const GoldenOptions& options) {
  if (options.scenes.empty()) return wholeLibrary();
  requireOwnNames(options.scenes, "golden", goldenFolder(options),
                  "take them one by one, with another --goldens for each");
  return options.scenes;
}

std::string describeNone(const std::string& name) {
  return fmt::format("none  {:<24} has no golden frames\n", name);
}

// Physics, view or renderer: the first layer that moved explains those after it.
std::string movedLayer(const GoldenHashes* recorded, const GoldenFrame& now, bool samePixels) {
  if (recorded == nullptr) return "no hashes recorded";
  if (recorded->state != now.hashes.state) return "the physics moved";
  if (recorded->picture != now.hashes.picture) return "only the picture moved: the view";
  return samePixels ? "" : "only the pixels moved: the renderer";
}

const GoldenHashes* findHashes(const GoldenRecord& record, int frame) {
  const auto found = record.frames.find(frame);
  return found == record.frames.end() ? nullptr : &found->second;
}

struct Golden {
  render::Image image;  // empty: there is none, or
  std::string problem;  // it cannot be read
};

// A damaged image is the finding of a check, not the end of it.
Golden readGolden(const fs::path& file) {
  if (!fs::exists(file)) return {};
  try {
    return {render::readPng(file), ""};
  } catch (const std::system_error&) {
    throw;
  } catch (const std::runtime_error& error) {
    constexpr std::string_view kPointer = "version https://git-lfs";
    std::string start(kPointer.size(), '\0');
    std::ifstream(file, std::ios::binary).read(start.data(), static_cast<long>(start.size()));
    const bool isPointer = start == kPointer;
    return {{}, isPointer ? file.string() + " is a Git LFS pointer: git lfs pull" : error.what()};
  }
}

std::string frameName(const scenes::Scene& scene, int frame) {
  return fmt::format("{} {:05}", scene.name, frame);
}

ImagePair compareFrame(const GoldenOptions& options, const scenes::Scene& scene,
                       const GoldenRecord& record, const GoldenRun& run, const GoldenFrame& now,
                       const fs::path& folder) {
  Golden golden = readGolden(goldenImage(folder, now.frame));
  ImagePair pair = comparePair(frameName(scene, now.frame), std::move(golden.image), now.image);
  if (!golden.problem.empty()) pair.comparison.reason = golden.problem;
  pair.remark = movedLayer(findHashes(record, now.frame), now, pair.comparison.identical);
  const std::string parting = describeParting(record.motion, run.motion, now.frame, run.bodyNames);
  if (!parting.empty()) pair.remark = "the physics moved " + parting;
  if (options.strict && !pair.remark.empty()) pair.passed = false;
  const std::string& promised = scene.golden.stateHash;
  if (now.frame == scene.golden.frames.back() && !promised.empty() &&
      promised != now.hashes.state) {
    pair.passed = false;
    pair.remark = fmt::format("[golden] says state {}, it is {}", promised, now.hashes.state);
  }
  return pair;
}

ImagePair failedPair(const std::string& name, const std::string& problem) {
  ImagePair pair = comparePair(name, {}, {});
  pair.comparison.reason = problem;
  return pair;
}

// The same scene simulated and drawn again: what differs from the first time is not steady.
void checkSteady(const GoldenOptions& options, const scenes::Scene& scene,
                 const GoldenRecord& record, const GoldenRun& first,
                 std::vector<ImagePair>& pairs) {
  std::vector<int> others(first.frames.size());
  for (int k = 1; k < options.repeat && !interrupted(); ++k) {
    const GoldenRun run =
        drawGoldenFrames(scene, record.motion.bounds, options.common.progressMode());
    for (std::size_t i = 0; i < std::min(run.frames.size(), first.frames.size()); ++i) {
      const bool same = run.frames[i].image == first.frames[i].image &&
                        run.frames[i].hashes == first.frames[i].hashes;
      if (!same) ++others[i];
    }
  }
  for (std::size_t i = 0; i < others.size(); ++i) {
    ImagePair& pair = pairs[pairs.size() - others.size() + i];
    const std::string steady = others[i] == 0
                                   ? fmt::format("steady in {} runs", options.repeat)
                                   : fmt::format("not steady: {} of {} runs differ from the first",
                                                 others[i], options.repeat);
    pair.remark += (pair.remark.empty() ? "" : "; ") + steady;
    if (others[i] != 0) pair.passed = false;
  }
}

// What one scene's goldens come to; fewer than asked for where the user interrupts.
std::vector<ImagePair> checkScene(const GoldenOptions& options, const std::string& name) {
  const scenes::Scene scene = scenes::readScene(name, options.common.overrides);
  const fs::path folder = goldenFolder(options) / scene.name;
  const GoldenRecord record = readGoldenRecord(folder);
  std::vector<ImagePair> pairs;
  if (scene.golden.frames.empty()) say(describeNone(name));
  if (!record.problem.empty()) {
    pairs.push_back(failedPair(scene.name + " golden.json", record.problem));
  }
  const GoldenRun run =
      drawGoldenFrames(scene, record.motion.bounds, options.common.progressMode());
  if (interrupted()) return pairs;
  for (const GoldenFrame& now : run.frames) {
    pairs.push_back(compareFrame(options, scene, record, run, now, folder));
  }
  if (options.repeat > 1) checkSteady(options, scene, record, run, pairs);
  for (std::size_t i = run.frames.size(); i < scene.golden.frames.size(); ++i) {
    pairs.push_back(failedPair(frameName(scene, scene.golden.frames[i]), run.problem));
  }
  return pairs;
}

// A pair's name is its scene's and its frame's.
std::vector<JunitCase> casesOf(const std::vector<ImagePair>& pairs) {
  std::vector<JunitCase> cases;
  for (const ImagePair& pair : pairs) {
    const std::size_t space = pair.name.rfind(' ');
    const std::string told = findings(pair) + (pair.remark.empty() ? "" : "; " + pair.remark);
    cases.push_back({pair.name.substr(0, space), pair.name.substr(space + 1),
                     pair.passed ? "" : told, pair.passed ? told : ""});
  }
  return cases;
}

ExitCode checkGoldens(const GoldenOptions& options) {
  std::vector<ImagePair> pairs;
  bool passed = true;
  for (const std::string& name : chosenScenes(options)) {
    for (ImagePair& pair : checkScene(options, name)) {
      passed = passed && pair.passed;
      if (!options.common.quiet) say(describePair(pair));
      pairs.push_back(std::move(pair));
    }
    if (interrupted()) return ExitCode::kInterrupted;
    flushOutput();
  }
  writeJunit(options.junit, "dbd golden check", casesOf(pairs));
  if (pairs.empty())
    throw CheckFailed("golden check: nothing was compared, there are no [golden] frames");
  if (passed) return ExitCode::kDone;
  const fs::path page =
      writeImageReport("Golden images", pairs, options.common.outputFolder("golden"));
  say(fmt::format(
      "want, got and difference: {}\nIf the change is meant: dbd golden update --reason \"...\"\n",
      page.string()));
  return ExitCode::kCheckFailed;
}

void removeStale(const GoldenRecord& before, const GoldenRecord& after, const fs::path& folder) {
  for (const auto& [frame, hashes] : before.frames) {
    if (!after.frames.contains(frame)) removeFile(goldenImage(folder, frame));
  }
}

// Writes the image where it is another one, and says what it is beside the one that was there.
bool updateFrame(const scenes::Scene& scene, const GoldenRecord& before, const GoldenFrame& now,
                 const fs::path& folder) {
  const fs::path file = goldenImage(folder, now.frame);
  const Golden golden = readGolden(file);
  const bool samePixels = golden.image == now.image;
  const std::string moved = movedLayer(findHashes(before, now.frame), now, samePixels);
  const std::string what = !golden.problem.empty() ? "new, for " + golden.problem
                           : !exists(golden.image) ? "new"
                           : moved.empty()         ? "unchanged"
                                                   : moved;
  say(fmt::format("{} {:05}: {}\n", scene.name, now.frame, what));
  if (!samePixels) {
    makeFolder(folder);
    render::writePng(now.image, file);
  }
  return !moved.empty();
}

// How many frames there are.
std::size_t updateScene(const GoldenOptions& options, const std::string& name) {
  const scenes::Scene scene = scenes::readScene(name, options.common.overrides);
  if (scene.golden.frames.empty()) say(describeNone(name));
  const fs::path folder = goldenFolder(options) / scene.name;
  const GoldenRecord before = readGoldenRecord(folder);
  const GoldenRun run = drawGoldenFrames(scene, {}, options.common.progressMode());
  if (interrupted()) return 0;
  if (!run.problem.empty()) throw CheckFailed(run.problem);
  GoldenRecord after{options.reason, {}, run.motion, ""};
  bool changed = before.frames.size() != run.frames.size();
  for (const GoldenFrame& now : run.frames) {
    after.frames[now.frame] = now.hashes;
    changed = updateFrame(scene, before, now, folder) || changed;
  }
  // A record that only gains the motion behind the same images keeps their reason.
  if (!changed) after.reason = before.reason;
  if (!changed && toJson(before.motion) == toJson(after.motion)) return run.frames.size();
  removeStale(before, after, folder);
  writeGoldenRecord(after, folder);
  return run.frames.size();
}

ExitCode updateGoldens(const GoldenOptions& options) {
  if (options.reason.find_first_not_of(" \t\n") == std::string::npos) {
    throw scenes::InputError("golden update: --reason must say why the pictures change");
  }
  std::size_t frames = 0;
  for (const std::string& name : chosenScenes(options)) {
    frames += updateScene(options, name);
    if (interrupted()) return ExitCode::kInterrupted;
    flushOutput();
  }
  if (frames == 0) {
    throw CheckFailed("golden update: nothing was approved, there are no [golden] frames");
  }
  return ExitCode::kDone;
}

CLI::App* addPart(CLI::App& command, GoldenOptions& options, const std::string& name,
                  const std::string& description) {
  CLI::App* part = command.add_subcommand(name, description);
  part->add_option("SCENE", options.scenes, "Scenes [all of the library]");
  part->add_option("--goldens", options.goldens, "Where the approved images are [tests/golden]")
      ->type_name("DIR");
  addCommon(*part, options.common);
  return part;
}

}  // namespace

void addGolden(CLI::App& line, Action& action) {
  auto options = std::make_shared<GoldenOptions>();
  CLI::App* command =
      line.add_subcommand("golden", "Compare with the approved pictures, or approve");
  command->require_subcommand(1);
  CLI::App* check = addPart(*command, *options, "check",
                            "Draw the golden frames and compare; exit code 3 when one differs");
  check->add_flag("--strict", options->strict, "Fail too where only a hash moved");
  check->add_option("--repeat", options->repeat, "Draw so often: which images are steady? [1]")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  check->add_option("--junit", options->junit, "Also write the results as JUnit's XML")
      ->type_name("F.xml");
  check->get_option("--out")->description("Folder for the report of differences [out/golden]");
  CLI::App* update = addPart(*command, *options, "update", "Approve the pictures as they are now");
  update->add_option("--reason", options->reason, "Why they change; kept beside them")
      ->required()
      ->type_name("TEXT");
  check->callback([options, &action] { action = [options] { return checkGoldens(*options); }; });
  update->callback([options, &action] { action = [options] { return updateGoldens(*options); }; });
}

}  // namespace app
