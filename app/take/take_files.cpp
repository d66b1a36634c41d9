// --player and --gltf: opened before the run, written after it.
#include "app/take/take_files.h"

#include <fmt/format.h>

#include "app/base/console.h"
#include "app/take/gltf.h"
#include "app/take/player.h"

namespace app {

namespace {

void requireEnding(const char* option, const std::string& file, bool isRight, const char* endings) {
  if (isRight) return;
  throw scenes::InputError(
      fmt::format("{} {}: expected a name that ends in {}", option, file, endings));
}

}  // namespace

TakeFiles::TakeFiles(const TakeOptions& options, const scenes::Simulation& start, int frames)
    : options_(options) {
  const std::string& player = options.player;
  if (!player.empty()) {
    requireEnding("--player", player, player.ends_with(".html") || player.ends_with(".htm"),
                  ".html");
    requireRoom(player, start, frames);
    player_.emplace(player);
  }
  const std::string& gltf = options.gltf;
  if (gltf.empty()) return;
  requireEnding("--gltf", gltf, gltf.ends_with(".glb") || gltf.ends_with(".gltf"), ".glb or .gltf");
  requireRoom(gltf, start, frames);
  gltf_.emplace(gltf);
}

void TakeFiles::write(const scenes::Scene& scene, const Motion& motion,
                      const scenes::Overlays& shown) {
  if (!options_.any()) return;
  scenes::Simulation simulation(scene);
  const Take take = recordTake(simulation, motion);
  for (const std::string& layer : take.missing) {
    note(fmt::format("dbd: {}: {} left out: too many to take along\n", options_.player, layer));
  }
  if (player_) {
    player_->write(playerPage(take, scene, shown));
    player_->commit();
  }
  if (gltf_) {
    gltf_->write(gltfFile(take, scene, !options_.gltf.ends_with(".gltf")));
    gltf_->commit();
  }
}

}  // namespace app
