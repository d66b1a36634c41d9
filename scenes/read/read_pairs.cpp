// [[no_contact]]: bodies that do not touch each other, or one that touches nothing.
#include "scenes/read/recipe.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Field;
using physics::Unit;

}  // namespace

void readNoContact(TableReader& reader, Recipe& recipe) {
  std::vector<int> bodies;
  physics::BodyRef body;
  reader.take("name");
  reader(Field{"bodies", Unit::kBody}, bodies);
  reader(Field{"body", Unit::kBody}, body);
  reader.exactlyOne("bodies", "body");
  const bool one = reader.has("body");
  recipe.add(reader, [=](Built& built) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) built.world.ignoreCollision(bodies[j], bodies[i]);
    }
    for (BodyId other = 0; one && other < built.world.bodyCount(); ++other) {
      if (other != body.id) built.world.ignoreCollision(body.id, other);
    }
  });
}

}  // namespace scenes
