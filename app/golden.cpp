// dbd golden: compares the pictures of the library with those that were approved, or approves them
// anew.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.h"
#include "app/console.h"
#include "app/golden_set.h"
#include "app/image_report.h"
#include "app/interrupt.h"
#include "app/output_file.h"
#include "render/png.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct GoldenOptions {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string goldens, reason;
  bool strict = false;
};

std::vector<std::string> chosenScenes(const GoldenOptions& options) {
  return options.scenes.empty() ? scenes::libraryScenes() : options.scenes;
}

fs::path goldenFolder(const GoldenOptions& options, const std::string& scene) {
  const fs::path root = options.goldens.empty()
                            ? fs::path(scenes::libraryFolder()) / ".." / ".." / "tests" / "golden"
                            : fs::path(options.goldens);
  return root.lexically_normal() / scene;
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

// Empty when there is no such file.
render::Image readGolden(const fs::path& file) {
  if (!fs::exists(file)) return {};
  return render::readPng(file);
}

ImagePair compareFrame(const GoldenOptions& options, const scenes::Scene& scene,
                       const GoldenRecord& record, const GoldenFrame& now, const fs::path& folder) {
  ImagePair pair = comparePair(fmt::format("{} {:05}", scene.name, now.frame),
                               readGolden(goldenImage(folder, now.frame)), now.image);
  pair.remark = movedLayer(findHashes(record, now.frame), now, pair.comparison.identical);
  if (options.strict && !pair.remark.empty()) pair.passed = false;
  const std::string& promised = scene.golden.stateHash;
  if (now.frame == scene.golden.frames.back() && !promised.empty() &&
      promised != now.hashes.state) {
    pair.passed = false;
    pair.remark = fmt::format("[golden] says state {}, it is {}", promised, now.hashes.state);
  }
  return pair;
}

ExitCode checkGoldens(const GoldenOptions& options) {
  std::vector<ImagePair> pairs;
  bool passed = true;
  for (const std::string& name : chosenScenes(options)) {
    const scenes::Scene scene = scenes::readScene(name, options.common.overrides);
    const fs::path folder = goldenFolder(options, scene.name);
    const GoldenRecord record = readGoldenRecord(folder);
    if (scene.golden.frames.empty()) say(fmt::format("none  {:<24} has no golden frames\n", name));
    const std::vector<GoldenFrame> drawn = drawGoldenFrames(scene, options.common.progressMode());
    if (interrupted()) return ExitCode::kInterrupted;
    for (const GoldenFrame& now : drawn) {
      pairs.push_back(compareFrame(options, scene, record, now, folder));
      passed = passed && pairs.back().passed;
      if (!options.common.quiet) say(describePair(pairs.back()));
    }
    flushOutput();
  }
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

void updateScene(const GoldenOptions& options, const std::string& name) {
  const scenes::Scene scene = scenes::readScene(name, options.common.overrides);
  const fs::path folder = goldenFolder(options, scene.name);
  const GoldenRecord before = readGoldenRecord(folder);
  GoldenRecord after{options.reason, {}};
  bool changed = false;
  const std::vector<GoldenFrame> drawn = drawGoldenFrames(scene, options.common.progressMode());
  if (interrupted()) return;
  for (const GoldenFrame& now : drawn) {
    after.frames[now.frame] = now.hashes;
    const fs::path file = goldenImage(folder, now.frame);
    const render::Image image = readGolden(file);
    const bool samePixels = image == now.image;
    const std::string moved = movedLayer(findHashes(before, now.frame), now, samePixels);
    say(fmt::format("{} {:05}: {}\n", scene.name, now.frame,
                    !exists(image)  ? "new"
                    : moved.empty() ? "unchanged"
                                    : moved));
    changed = changed || !moved.empty();
    if (samePixels) continue;
    makeFolder(folder);
    render::writePng(now.image, file);
  }
  if (!changed && before.frames.size() == after.frames.size()) return;
  removeStale(before, after, folder);
  writeGoldenRecord(after, folder);
}

ExitCode updateGoldens(const GoldenOptions& options) {
  if (options.reason.find_first_not_of(" \t\n") == std::string::npos) {
    throw scenes::InputError("golden update: --reason must say why the pictures change");
  }
  for (const std::string& name : chosenScenes(options)) {
    updateScene(options, name);
    if (interrupted()) return ExitCode::kInterrupted;
    flushOutput();
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
  check->get_option("--out")->description("Folder for the report of differences [out/golden]");
  CLI::App* update = addPart(*command, *options, "update", "Approve the pictures as they are now");
  update->add_option("--reason", options->reason, "Why they change; kept beside them")
      ->required()
      ->type_name("TEXT");
  check->callback([options, &action] { action = [options] { return checkGoldens(*options); }; });
  update->callback([options, &action] { action = [options] { return updateGoldens(*options); }; });
}

}  // namespace app
