// Who races, and with which method of an engine: the one that its manual begins with.
#include "app/race/race_engines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/build_info.h"
#include "app/base/nearest.h"
#include "scenes/joined.h"
#include "scenes/measure/survey.h"
#include "scenes/read/settings_reader.h"

namespace app {

namespace {

constexpr const char* kOurs = "dbd";

struct Word {
  const char *word, *engine, *method;  // of PeerEngine, of PeerMethod
  double step;                         // that its users begin with [s]
};
constexpr Word kWords[] = {{"bullet", "Bullet", "bullet", 1.0 / 60},
                           {"ode", "ODE", "ode_quick", 1.0 / 60},
                           {"mujoco", "MuJoCo", "mujoco", 0.002}};

const PeerEngine* findEngine(const std::vector<PeerEngine>& engines, const std::string& name) {
  const auto found = std::find_if(engines.begin(), engines.end(),
                                  [&](const PeerEngine& engine) { return engine.name == name; });
  return found == engines.end() ? nullptr : &*found;
}

RaceEntry ourEntry(const scenes::Scene& scene) {
  const physics::Settings& s = scene.settings;
  std::string setup =
      s.accuracy ? fmt::format("accuracy {:.3g}", *s.accuracy) : scenes::substepsText(s);
  if (s.sleep) setup += ", what rests sleeps";
  return {kOurs, "dbd " + version(), setup, ""};
}

std::string peerSetup(const PeerMethod& method, int steps, int fps) {
  std::string setup = steps == 1 ? fmt::format("one step of 1/{} s", fps)
                                 : fmt::format("{} steps of 1/{} s", steps, steps * fps);
  if (method.iterations > 0) setup += fmt::format(", {} iterations", method.iterations);
  return setup;
}

// What moves by a script turns under our hands only.
bool isScripted(const scenes::Scene& scene) {
  const scenes::Survey survey(scene);
  return !survey.built.scripts.empty() || !survey.built.armScripts.empty();
}

}  // namespace

std::vector<std::string> raceEngines() {
  const std::vector<PeerEngine> engines = peerEngines();
  std::vector<std::string> words{kOurs};
  for (const Word& word : kWords) {
    const PeerEngine* engine = findEngine(engines, word.engine);
    if (engine != nullptr && !engine->version.empty()) words.emplace_back(word.word);
  }
  return words;
}

std::vector<std::string> missingRaceEngines() {
  std::vector<std::string> lines;
  for (const PeerEngine& engine : peerEngines()) {
    if (!engine.version.empty()) continue;
    lines.push_back(
        fmt::format("{}: was not found when this was built ({})", engine.name, engine.package));
  }
  return lines;
}

std::vector<std::string> checkedRaceEngines(const std::vector<std::string>& words) {
  const std::vector<std::string> known = raceEngines();
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (std::find(words.begin(), word, *word) != word) {
      throw scenes::InputError(fmt::format("--engines: {} is named twice", *word));
    }
    if (std::find(known.begin(), known.end(), *word) != known.end()) continue;
    const auto* other = std::find_if(std::begin(kWords), std::end(kWords),
                                     [&](const Word& w) { return *word == w.word; });
    const std::string nearest = nearestWord(*word, known);
    throw scenes::InputError(
        other != std::end(kWords)
            ? fmt::format("--engines: {} was not found when this was built; see dbd doctor", *word)
            : fmt::format("--engines: no engine '{}'; {}", *word,
                          nearest.empty() ? fmt::format("there are {}", scenes::joined(known, ", "))
                                          : fmt::format("did you mean '{}'?", nearest)));
  }
  if (words.size() < 2) throw scenes::InputError("--engines: a race takes two engines or more");
  return words;
}

RaceStarter startRacer(const std::string& engine, const scenes::Simulation& simulation) {
  const scenes::Scene& scene = simulation.scene();
  if (engine == kOurs) return {ourEntry(scene), nullptr, 1};
  const auto* word = std::find_if(std::begin(kWords), std::end(kWords),
                                  [&](const Word& w) { return engine == w.word; });
  const std::vector<PeerEngine> engines = peerEngines();
  const PeerEngine* found = findEngine(engines, word->engine);
  RaceStarter starter;
  starter.entry = {engine, found->name + " " + found->version.substr(0, found->version.find(',')),
                   "", ""};
  starter.steps = std::max(1, static_cast<int>(std::lround(1 / (scene.fps * word->step))));
  for (const PeerMethod& method : peerMethods()) {
    if (method.name == word->method)
      starter.entry.setup = peerSetup(method, starter.steps, scene.fps);
  }
  PeerStart start = startPeer(word->method, simulation.world());
  starter.entry.refusal = start.refusal;
  if (start.refusal.empty() && isScripted(scene)) {
    starter.entry.refusal = "other engines do not follow the scripts of a scene: poses over time";
  }
  starter.peer = std::move(start.peer);
  return starter;
}

}  // namespace app
