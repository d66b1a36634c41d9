// Steps that build a world: run once while reading, to check them, and again for every Simulation.
#include "scenes/read/recipe.h"

#include <fmt/format.h>

#include <cmath>

#include "physics/bodies/compound.h"
#include "physics/make/matter.h"
#include "scenes/view/shape_mesh.h"

namespace scenes {
Built::Built(const physics::Settings& settings)
    : world(settings), names{"world"}, ids{{"world", physics::kWorldBody}} {
  appearance.colors.push_back(fixedColor());
  appearance.meshes.emplace_back();
  appearance.hidden.push_back(false);
}

void Built::name(physics::BodyId body, const std::string& bodyName, const render::Color& color) {
  physics::require(body == static_cast<physics::BodyId>(names.size()),
                   "bodies are named in the order they were added");
  alias(body, bodyName);
  names.push_back(bodyName);
  appearance.colors.push_back(color);
  const physics::Shape& shape = world.bodies().shape[body];
  appearance.meshes.push_back(meshOf(shape));
  if (const auto* several = std::get_if<physics::Compound>(&shape)) {
    for (const physics::Part& part : several->parts->list) {
      appearance.parts[body].push_back({meshOf(part.shape), {}});
    }
  }
  appearance.hidden.push_back(false);
}

void Built::place(physics::BodyId body, const physics::Pose& toFile) {
  const physics::Quat back = toFile.q.conjugate();
  const physics::Pose frame{-(back * toFile.x), back};
  if (!frame.x.isZero(0) || !frame.q.vec().isZero(0)) frames[body] = frame;
}

void Built::alias(physics::BodyId body, const std::string& second) {
  const auto [place, isNew] = ids.emplace(second, body);
  physics::require(isNew, fmt::format("expected a new name, '{}' is a body already", second));
}

void Built::nameAll(const std::vector<physics::BodyId>& bodies, const std::string& family,
                    Pattern pattern, const std::optional<render::Color>& color) {
  const int hue = families++;
  int row = 0;
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    const auto heightOf = [&](int k) { return world.bodies().pose[bodies[k]].x.y(); };
    if (i > 0 && std::abs(heightOf(i) - heightOf(i - 1)) > 1e-6) ++row;
    const bool moves = world.bodies().motion[bodies[i]] == physics::Motion::kDynamic;
    const render::Color own = moves ? familyColor(pattern, hue, i, row) : fixedColor();
    name(bodies[i], fmt::format("{}.{}", family, i), color.value_or(own));
  }
}

Recipe::Recipe(const Scene& scene, Context& context) : trial_(scene.settings), seed_(scene.seed) {
  context.ids = &trial_.ids;
}

void Recipe::add(const TableReader& reader, Step step) {
  try {
    step(trial_);
  } catch (const std::invalid_argument& error) {
    reader.failHere(error.what());
  }
  const int bodies = trial_.world.bodyCount() - 1;
  if (bodies > physics::kMostBodies) {
    reader.failHere(fmt::format("expected at most {} bodies in a scene, got {} with these",
                                physics::kMostBodies, bodies));
  }
  content_.steps.push_back(std::move(step));
  content_.origins.push_back({reader.key(), reader.table().place});
}

unsigned Recipe::nextSeed() { return seed_ = seed_ * 1664525u + 1013904223u; }

std::string readName(TableReader& reader, const std::string& otherwise) {
  std::string name = otherwise;
  reader(physics::Field{"name"}, name);
  if (name.empty()) reader.failAt("name", "expected a name, got ''");
  if (name == "world") reader.failAt("name", "expected a name of its own, 'world' is the world");
  return name;
}

}  // namespace scenes
