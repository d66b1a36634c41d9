// dbd doctor: what of the machine works, and what to install where it does not.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/base/build_info.h"
#include "app/base/console.h"
#include "app/commands/commands.h"
#include "app/peers/peer.h"
#include "app/run/open_renderer.h"

namespace app {

namespace {

struct Finding {
  std::string what, value;
  bool works = true;
  std::string package;  // what brings it
};

// First line that the command prints; empty when it cannot be run.
std::string firstLine(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return "";
  std::array<char, 256> buffer{};
  std::string line;
  if (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) line = buffer.data();
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) {
  }
  pclose(pipe);
  if (!line.empty() && line.back() == '\n') line.pop_back();
  return line;
}

Finding findProgram(const std::string& what, const std::string& command,
                    const std::string& package) {
  const std::string line = firstLine(command);
  if (line.empty()) return {what, "not found", false, package};
  return {what, line, true, package};
}

std::string cpuClass() {
  std::string level = "x86-64";
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") != 0) {
    level = "x86-64 with AVX-512";
  } else if (__builtin_cpu_supports("avx2") != 0) {
    level = "x86-64 with AVX2";
  }
#else
  level = "not x86-64: golden images may differ";
#endif
  return fmt::format("{}, {} threads", level, std::thread::hardware_concurrency());
}

Finding findRenderer() {
  try {
    constexpr int kSide = 64;
    const auto renderer = openRenderer({kSide, kSide, render::Quality::kDraft, ""});
    renderer->draw(render::Picture());
    const render::Renderer::Info info = renderer->info();
    return {"renderer", fmt::format("{}, OpenGL {}", info.renderer, info.version), true, ""};
  } catch (const std::exception& error) {
    return {"renderer", error.what(), false, "libosmesa6"};
  }
}

Finding findFont() {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::path(scenes::assetFolder()) / "fonts";
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".ttf") return {"font", entry.path().string(), true, ""};
  }
  return {"font", "no .ttf in " + folder.string() + "; is DBD_HOME right?", false, ""};
}

Finding findScenes() {
  const std::size_t count = scenes::libraryScenes().size();
  return {"scenes", fmt::format("{} in {}", count, scenes::libraryFolder()), count > 0, ""};
}

// Other engines are for studies and races: nothing fails without them.
Finding findPeer(const PeerEngine& engine) {
  if (!engine.version.empty()) return {engine.name, engine.version, true, ""};
  return {engine.name, "not built in: studies and races go without; " + engine.package, true, ""};
}

ExitCode doctor() {
  std::vector<Finding> findings = {
      {"dbd", version() + ", " + compiler(), true, ""},
      {"cpu", cpuClass(), true, ""},
      findRenderer(),
      findFont(),
      findScenes(),
      findProgram("ffmpeg", "ffmpeg -hide_banner -version", "ffmpeg"),
      findProgram("gnuplot", "gnuplot --version", "gnuplot-nox"),
  };
  for (const PeerEngine& engine : peerEngines()) findings.push_back(findPeer(engine));
  std::string missing;
  bool works = true;
  for (const Finding& finding : findings) {
    say(fmt::format("{:<5} {:<9} {}\n", finding.works ? "ok" : "FAIL", finding.what,
                    finding.value));
    works = works && finding.works;
    if (!finding.works && !finding.package.empty()) missing += " " + finding.package;
  }
  if (!missing.empty())
    say("\nTo install what is missing:\n  sudo apt-get install -y" + missing + "\n");
  return works ? ExitCode::kDone : ExitCode::kEnvironment;
}

}  // namespace

void addDoctor(CLI::App& line, Action& action) {
  CLI::App* command =
      line.add_subcommand("doctor", "What of this machine works, and what to install");
  command->callback([&action] { action = doctor; });
}

}  // namespace app
