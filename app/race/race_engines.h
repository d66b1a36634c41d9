// Who races: each engine at its own defaults, or the reason why it does not run the scene.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/peers/peer.h"
#include "scenes/simulation.h"

namespace app {

struct RaceEntry {
  std::string engine;   // the word of --engines
  std::string title;    // "Bullet 3.24"
  std::string setup;    // what its defaults are, a line
  std::string refusal;  // why it does not run; empty: it does
};

// An entry, and the engine where it is another one and runs.
struct RaceStarter {
  RaceEntry entry;
  std::unique_ptr<Peer> peer;
  int steps = 1;  // of the peer in a frame
};

// "dbd", and the words of those that were found when this was built.
std::vector<std::string> raceEngines();
// "MuJoCo: not built in (libmujoco-dev)", a line each.
std::vector<std::string> missingRaceEngines();

// Throws InputError for a word that is none, or given twice, or fewer than two.
std::vector<std::string> checkedRaceEngines(const std::vector<std::string>& words);

RaceStarter startRacer(const std::string& engine, const scenes::Simulation& simulation);

}  // namespace app
