// Every kind of constraint by its word, read through its own list of fields.
#include <string_view>

#include "physics/make/hinge.h"
#include "physics/make/prismatic.h"
#include "physics/make/universal.h"
#include "physics/make/weld.h"
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

// What is given in the frames that the file has of bodies, in the bodies' own: a visitor of
// `fields`. Points and axes share a unit; axes are told by their name.
struct IntoBodies {
  std::array<physics::Pose, 2> frames;  // the file's in the body's own

  void operator()(const physics::Field& field, std::array<physics::Vec3, 2>& pair) const {
    if (field.unit != physics::Unit::kBodyPoint) return;
    const bool isAxis = std::string_view(field.name) == "axes";
    for (int k = 0; k < 2; ++k) {
      pair[k] = frames[k].q * pair[k] + (isAxis ? physics::Vec3::Zero() : frames[k].x);
    }
  }
  void operator()(const physics::Field& field,
                  std::optional<std::array<physics::Vec3, 2>>& pair) const {
    if (pair) (*this)(field, *pair);
  }
  // Orientation of the second body in the first one's frame.
  void operator()(const physics::Field&, std::optional<physics::Quat>& turn) const {
    if (turn) turn = (frames[0].q * *turn * frames[1].q.conjugate()).normalized();
  }
  template <class T>
  void operator()(const physics::Field&, T&) const {}
};

template <class Def>
void intoBodies(const Recipe& recipe, Def& def) {
  if constexpr (std::is_same_v<decltype(def.bodies), std::array<physics::BodyId, 2>>) {
    const auto& known = recipe.trial().frames;
    IntoBodies visitor;
    for (int k = 0; k < 2; ++k) {
      const auto found = known.find(def.bodies[k]);
      if (found != known.end()) visitor.frames[k] = found->second;
    }
    Def::fields(visitor, def);
  }
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
  intoBodies(recipe, def);
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
    word<physics::ForceDef>(),         word<physics::WeldDef>(),
    {"no_contact", readNoContact},
};

}  // namespace

std::span<const Word> constraintWords() { return kConstraints; }

}  // namespace scenes
