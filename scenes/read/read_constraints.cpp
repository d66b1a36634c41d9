// Every kind of constraint by its word, read through its own list of fields.
#include "physics/make/hinge.h"
#include "physics/make/prismatic.h"
#include "physics/make/universal.h"
#include "scenes/read/recipe.h"

namespace scenes {
namespace {

// Two ways to say the same thing: exactly one is needed where a kind knows both.
constexpr const char* kAlternatives[][2] = {{"at", "anchors"}, {"axis", "axes"}};

void checkMovable(const TableReader& reader, const Recipe& recipe,
                  std::span<const physics::BodyId> bodies) {
  for (const physics::BodyId body : bodies) {
    if (recipe.trial().world.bodies().motion[body] == physics::Motion::kDynamic) return;
  }
  reader.failAt(reader.has("body") ? "body" : "bodies", "expected at least one body that can move");
}

template <class Def>
void readConstraint(TableReader& reader, Recipe& recipe) {
  Def def;
  Def::fields(reader, def);
  reader.take("name");
  for (const auto& [a, b] : kAlternatives) {
    if (reader.knows(a) && reader.knows(b)) reader.exactlyOne(a, b);
  }
  checkMovable(reader, recipe, def.bodies);
  recipe.add(reader, [def](Built& built) {
    using physics::add;
    if constexpr (requires { built.world.add(def); }) {
      built.world.add(def);
    } else {
      add(built.world, def);
    }
  });
}

template <class Def>
constexpr Word word() {
  return {Def::kWord, readConstraint<Def>};
}

constexpr Word kConstraints[] = {
    word<physics::BallSocketDef>(),    word<physics::AxleDef>(),
    word<physics::HingeDef>(),         word<physics::ConeLimitDef>(),
    word<physics::TwistLimitDef>(),    word<physics::DistanceDef>(),
    word<physics::LinkDef>(),          word<physics::RopeLengthDef>(),
    word<physics::VolumeDef>(),        word<physics::SpringDef>(),
    word<physics::DriveDef>(),         word<physics::MotorDef>(),
    word<physics::BendDef>(),          word<physics::HardeningSpringDef>(),
    word<physics::DragDef>(),          word<physics::PanelDragDef>(),
    word<physics::MotorTorqueDef>(),   word<physics::PointGravityDef>(),
    word<physics::PrismaticDef>(),     word<physics::UniversalDef>(),
    word<physics::PointOnLineDef>(),   word<physics::SlideLimitDef>(),
    word<physics::PerpendicularDef>(), word<physics::OrientationLockDef>(),
    word<physics::ForceDef>(),
};

}  // namespace

std::span<const Word> constraintWords() { return kConstraints; }

}  // namespace scenes
