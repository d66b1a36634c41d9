// Every word that makes bodies, each read through its own list of fields.
#include "physics/make/arch.h"
#include "physics/make/cards.h"
#include "physics/make/chain.h"
#include "physics/make/stack.h"
#include "physics/make/stage.h"
#include "scenes/read/read_arm.h"
#include "scenes/read/read_body.h"
#include "scenes/read/recipe.h"
#include "scenes/read/whole_velocity.h"
#include "scenes/view/palette.h"

namespace scenes {
namespace {

// A last link that differs from the others only in its weight is told by its colour.
void markEnd(const physics::ChainDef& def, physics::BodyId last, const std::string& name,
             const std::optional<render::Color>& color, Built& built) {
  built.alias(last, name + ".end");
  const bool looksAlike = def.end && !def.end->shape;
  if (looksAlike && !color) {
    built.appearance.colors[last] = familyColor(Pattern::kSingle, built.families++, 0);
  }
}

template <class Def, Pattern pattern>
void readGenerator(TableReader& reader, Recipe& recipe) {
  Def def;
  const unsigned seed = recipe.nextSeed();
  if constexpr (requires { def.seed; }) def.seed = seed;
  const std::string name = readName(reader, Def::kWord);
  Def::fields(reader, def);
  reader.atMostOne("mass", "density");
  reader.atMostOne("shape", "length");
  reader.atMostOne("to", "direction");
  WholeVelocity start;  // of what moves, and has none of each body
  if constexpr (
      requires { def.matter; } && !requires { def.velocity; })
    start.read(reader);
  std::optional<render::Color> color;
  readColor(reader, color);
  recipe.add(reader, [=](Built& built) {
    const std::vector<physics::BodyId> bodies = physics::add(built.world, def);
    start.give(built.world, bodies);
    built.nameAll(bodies, name, pattern, color);
    if constexpr (requires { def.end; }) markEnd(def, bodies.back(), name, color, built);
  });
}

template <class Def, Pattern pattern>
constexpr Word word() {
  return {Def::kWord, readGenerator<Def, pattern>};
}

constexpr Word kWords[] = {
    {"body", readBody},
    word<physics::StackDef, Pattern::kRows>(),
    word<physics::PyramidDef, Pattern::kRows>(),
    word<physics::WallDef, Pattern::kRows>(),
    word<physics::GridDef, Pattern::kVaried>(),
    word<physics::ChainDef, Pattern::kAlternate>(),
    word<physics::BridgeDef, Pattern::kAlternate>(),
    word<physics::ArchDef, Pattern::kAlternate>(),
    word<physics::CardHouseDef, Pattern::kAlternate>(),
    word<physics::DominoesDef, Pattern::kAlternate>(),
    word<physics::BowlDef, Pattern::kSingle>(),
    word<physics::StairsDef, Pattern::kSingle>(),
    {"ragdoll", readRagdoll},
    {"bvh", readBvh},
    {"soft_body", readSoftBody},
    {"cloth", readCloth},
    {"rope", readRope},
    {"arm", readArm},  // the last: it may follow any body
};

}  // namespace

std::span<const Word> bodyWords() { return kWords; }

}  // namespace scenes
