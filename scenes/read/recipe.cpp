// Steps that build a world: run once while reading, to check them, and again for every Simulation.
#include "scenes/read/recipe.h"

#include <fmt/format.h>

#include <cmath>

#include "physics/make/matter.h"

namespace scenes {
namespace {

std::shared_ptr<const render::Mesh> meshOf(const physics::Shape& shape) {
  const auto* convex = std::get_if<physics::Convex>(&shape);
  if (convex == nullptr) return nullptr;
  auto mesh = std::make_shared<render::Mesh>();
  for (const physics::Hull::Face& face : convex->hull->faces) {
    const auto first = static_cast<std::uint32_t>(mesh->positions.size());
    for (const int vertex : face.vertices) {
      mesh->positions.push_back(convex->hull->vertices[vertex].cast<float>());
      mesh->normals.push_back(face.normal.cast<float>());
    }
    for (std::uint32_t i = 2; i < face.vertices.size(); ++i) {
      mesh->indices.insert(mesh->indices.end(), {first, first + i - 1, first + i});
    }
  }
  return mesh;
}

}  // namespace

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
  auto mesh = meshOf(shape);
  appearance.meshes.push_back(std::move(mesh));
  appearance.hidden.push_back(false);
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
