// A page that plays a run: assets/player/player.html with its scripts and the run's numbers inside.
#include "app/take/player.h"

#include <fmt/format.h>

#include <map>

#include "app/base/build_info.h"
#include "app/base/html.h"
#include "app/base/json.h"
#include "app/commands/exit_code.h"
#include "app/take/numbers.h"
#include "render/geometry.h"
#include "render/marked_text.h"
#include "scenes/read/file_text.h"

namespace app {

namespace {

constexpr int kSegments = 32;  // of round bodies
constexpr const char* kScripts[] = {"take.js",   "view.js",     "shaders.js",
                                    "bodies.js", "surfaces.js", "strokes.js",
                                    "scene.js",  "told.js",     "player.js"};

std::string readAsset(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(scenes::assetFolder()) / "player" / name;
  const std::optional<std::string> text = scenes::fileText(path);
  if (text) return *text;
  throw EnvironmentError(path.string() + ": it is needed for a player, and cannot be read");
}

Json numbers(const render::Vec3f& v) { return {v.x(), v.y(), v.z()}; }
Json numbers(const render::Color& c) { return {c.x(), c.y(), c.z(), c.w()}; }

// The geometries of all parts, each once.
class Geometries {
 public:
  std::size_t of(const render::Instance& look) {
    const std::pair key(look.primitive, look.mesh.get());
    const auto [found, isNew] = places_.try_emplace(key, all_.size());
    if (isNew) all_.push_back(make(look));
    return found->second;
  }
  const std::vector<render::Geometry>& all() const { return all_; }

 private:
  static render::Geometry make(const render::Instance& look) {
    switch (look.primitive) {
      case render::Primitive::kBox:
        return render::unitBox();
      case render::Primitive::kSphere:
        return render::unitSphere(kSegments);
      case render::Primitive::kCapsule:
        return render::unitCapsule(kSegments);
      case render::Primitive::kCylinder:
        return render::unitCylinder(kSegments);
      case render::Primitive::kMesh:
        break;
    }
    return render::geometryOf(*look.mesh);
  }

  std::map<std::pair<render::Primitive, const render::Mesh*>, std::size_t> places_;
  std::vector<render::Geometry> all_;
};

void addGeometries(const Geometries& geometries, Json& head, TakeNumbers& numbers) {
  head["geometries"] = Json::array();
  for (const render::Geometry& geometry : geometries.all()) {
    head["geometries"].push_back(
        {{"vertices", geometry.vertices.size()}, {"indices", geometry.indices.size()}});
    std::vector<float> rows;
    for (const render::Vertex& vertex : geometry.vertices) {
      rows.insert(rows.end(), vertex.position.begin(), vertex.position.end());
      rows.insert(rows.end(), vertex.normal.begin(), vertex.normal.end());
      rows.insert(rows.end(), vertex.edge.begin(), vertex.edge.end());
    }
    numbers.add(rows);
    numbers.add(geometry.indices);
  }
}

// A row a part: geometry, 1 for a capsule, size.x, size.z, colour, 1 for a marked one.
void addParts(const Take& take, Json& head, TakeNumbers& numbers) {
  Geometries geometries;
  std::vector<float> rows;
  head["names"] = Json::array();
  for (const TakePart& part : take.parts) {
    const render::Instance& look = part.look;
    const float capsule = look.primitive == render::Primitive::kCapsule ? 1 : 0;
    rows.insert(rows.end(), {static_cast<float>(geometries.of(look)), capsule, look.size.x(),
                             look.size.z(), look.color.x(), look.color.y(), look.color.z(),
                             look.color.w(), look.marked ? 1.0f : 0.0f});
    head["names"].push_back(part.name);
  }
  numbers.add(rows);
  addGeometries(geometries, head, numbers);
}

void addSurfaces(const Take& take, Json& head, TakeNumbers& packed) {
  head["surfaces"] = Json::array();
  for (const TakeSurface& surface : take.surfaces) {
    const render::Surface& look = surface.look;
    head["surfaces"].push_back({{"positions", look.positions.size()},
                                {"indices", look.indices.size()},
                                {"grid", !look.grid.empty()},
                                {"edges", look.edges},
                                {"offset", look.offset},
                                {"color", numbers(look.color)},
                                {"back", numbers(look.backColor)}});
    packed.add(look.indices);
    std::vector<float> grid;
    for (const Eigen::Vector2f& cell : look.grid) grid.insert(grid.end(), {cell.x(), cell.y()});
    packed.add(grid);
  }
}

void addLayers(const Take& take, Json& head, TakeNumbers& packed) {
  head["layers"] = Json::array();
  for (const TakeLayer& layer : take.layers) {
    Json styles = Json::array();
    for (const TakeStyle& style : layer.styles) {
      styles.push_back(
          {{"color", numbers(style.color)}, {"width", style.width}, {"arrow", style.arrow}});
    }
    head["layers"].push_back(
        {{"name", layer.name}, {"styles", styles}, {"strokes", layer.strokes}});
    packed.addLayer(layer);
  }
}

// Each with its text as runs of one size and slant.
void addLabels(const Take& take, Json& head, TakeNumbers& packed) {
  head["labels"] = Json::array();
  for (const render::Label& label : take.labels) {
    Json runs = Json::array();
    for (const render::TextRun& run : render::textRuns(label.text)) {
      runs.push_back({{"words", run.words}, {"level", run.level}, {"slanted", run.slanted}});
    }
    head["labels"].push_back(
        {{"runs", runs}, {"size", label.size}, {"offset", {label.offset.x(), label.offset.y()}}});
  }
  packed.addTracks(take.labelPlaces);
}

Json describeStage(const render::Picture& stage) {
  return {{"ground",
           {{"visible", stage.ground.visible},
            {"height", stage.ground.height},
            {"spacing", stage.ground.spacing},
            {"color", numbers(stage.ground.color)}}},
          {"light", numbers(stage.light.direction)},
          {"shadows", stage.light.shadows},
          {"focus", {{"center", numbers(stage.focusCenter)}, {"radius", stage.focusRadius}}}};
}

std::string aboutText(const Take& take, const scenes::Scene& scene) {
  std::string text = fmt::format("{}, {} frames at {} a second", scene.name, take.frames, take.fps);
  for (const std::string& set : scene.overrides) text += ", " + set;
  return text + "; dbd " + version();
}

// Text within a <script> element: nothing in it may look like the element's end.
std::string asScript(const Json& json) {
  std::string text = jsonText(json, -1, true);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

// Fills in every {{word}} of the page; what is filled in is not looked at again.
std::string filled(const std::string& page, const std::map<std::string, std::string>& words) {
  std::string text;
  std::size_t at = 0;
  for (std::size_t open = 0; (open = page.find("{{", at)) != std::string::npos;) {
    const std::size_t close = page.find("}}", open);
    text.append(page, at, open - at);
    text += words.at(page.substr(open + 2, close - open - 2));
    at = close + 2;
  }
  return text.append(page, at);
}

}  // namespace

std::string playerPage(const Take& take, const scenes::Scene& scene,
                       const scenes::Overlays& shown) {
  Json head = describeStage(take.stage);
  head["fps"] = take.fps;
  head["frames"] = take.frames;
  head["speed"] = scene.film.speed;
  head["metrics"] = take.metricNames;
  head["missing"] = take.missing;
  head["description"] = scene.description;
  head["about"] = aboutText(take, scene);
  head["shown"] = {"labels", "shadows"};
  for (const auto& [name, isShown] : takeLayers()) {
    if (shown.*isShown) head["shown"].push_back(name);
  }
  if (shown.centresOfMass) head["shown"].push_back("masses");
  TakeNumbers packed;
  addParts(take, head, packed);
  packed.addTracks(take.poses);
  addSurfaces(take, head, packed);
  packed.addTracks(take.positions);
  packed.addTracks(take.cameras);
  addLabels(take, head, packed);
  packed.addTracks(take.metrics);
  addLayers(take, head, packed);
  const std::string title = scene.title.empty() ? scene.name : scene.title;
  std::map<std::string, std::string> words = {{"title", escapeHtml(title)},
                                              {"style", readAsset("player.css")},
                                              {"take", asScript(head)},
                                              {"numbers", packed.packed()}};
  for (const char* script : kScripts) words[script] = readAsset(script);
  return filled(readAsset("player.html"), words);
}

}  // namespace app
