// A run to take along: every frame is shown again, and what its picture has is kept.
#include "app/take/take.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/commands/exit_code.h"
#include "scenes/moment.h"
#include "scenes/view/camera.h"
#include "scenes/view/overlays.h"
#include "scenes/view/stage.h"

namespace app {

namespace {

// A browser holds a page's text in one string of some 500 MB; a number takes up to 2.7 letters.
constexpr double kMostNumbers = 1e8;
constexpr std::size_t kMostStrokes = 4'000'000;  // of a layer; one takes up to 18 letters

constexpr std::pair<const char*, bool scenes::Overlays::*> kLayers[] = {
    {"contacts", &scenes::Overlays::contacts},
    {"impulses", &scenes::Overlays::impulses},
    {"joints", &scenes::Overlays::joints},
    {"arms", &scenes::Overlays::arms},
};

// Fits the motion even where the scene's camera follows keys: what is sized by the picture then
// keeps its size.
scenes::ViewOptions viewOptions(const scenes::Scene& scene) {
  scenes::ViewOptions options;
  options.camera = scene.camera;
  options.camera->keys.clear();
  return options;
}

void append(std::vector<float>& row, const render::Vec3f& v) {
  row.insert(row.end(), {v.x(), v.y(), v.z()});
}

bool looksLike(const render::Instance& a, const render::Instance& b) {
  return a.primitive == b.primitive && a.mesh == b.mesh && a.color == b.color &&
         a.marked == b.marked && a.size.x() == b.size.x() && a.size.z() == b.size.z();
}

class TakeRecorder {
 public:
  TakeRecorder(scenes::Simulation& simulation, const Motion& motion)
      : simulation_(simulation), motion_(motion), options_(viewOptions(simulation.scene())) {}

  Take record() {
    const int every = simulation_.scene().film.every;
    take_.fps = simulation_.scene().fps / every;
    scenes::MotionBounds bounds;
    for (int frame = 0; frame < motion_.frames(); ++frame) {
      bounds.include(simulation_, *options_.camera, motion_.moment(frame).poses);
    }
    for (const auto& [name, shown] : kLayers) take_.layers.push_back({name, {}, {}});
    for (int frame = 0; frame < motion_.frames(); frame += every) {
      const scenes::Moment moment = motion_.moment(frame);
      if (!simulation_.show(moment)) {
        throw CheckFailed(fmt::format("frame {} is not finite", frame));
      }
      add(scenes::view(simulation_, bounds, options_, {}), moment);
    }
    take_.frames = static_cast<int>(take_.poses.size());
    dropLayers();
    return std::move(take_);
  }

 private:
  void add(const render::Picture& picture, const scenes::Moment& moment) {
    if (moment.frame == 0) begin(picture, moment);
    addPoses(picture.instances);
    addPositions(picture.surfaces);
    addCamera(picture.camera);
    addLabels();
    const std::vector<double> numbers = numbersOf(moment).metrics;
    take_.metrics.emplace_back(numbers.begin(), numbers.end());
    for (std::size_t i = 0; i < std::size(kLayers); ++i) addLayer(i, picture);
  }

  void begin(const render::Picture& picture, const scenes::Moment& moment) {
    take_.labels = scenes::labels(simulation_);
    for (std::size_t i = 0; i < take_.labels.size(); ++i) {
      take_.labels[i].text = simulation_.scene().labels[i].text;
    }
    take_.stage.camera = picture.camera;
    take_.stage.light = picture.light;
    take_.stage.ground = picture.ground;
    take_.stage.focusCenter = picture.focusCenter;
    take_.stage.focusRadius = picture.focusRadius;
    take_.metricNames = scenes::numberNames(moment.metrics);
    for (const physics::BodyId body : drawnBodies(simulation_)) {
      take_.parts.push_back({picture.instances[take_.parts.size()], simulation_.bodyName(body)});
    }
    bodies_ = take_.parts.size();
    std::size_t positions = 0;
    for (const render::Surface& surface : picture.surfaces) {
      take_.surfaces.push_back({surface, positions});
      positions += surface.positions.size();
    }
  }

  // Bodies are in their places; a rod that is too short to see is left out of a picture, so that
  // the others move up.
  std::size_t partOf(const render::Instance& instance, std::size_t& next) {
    if (next < bodies_) return next++;
    for (std::size_t part = next; part < take_.parts.size(); ++part) {
      if (!looksLike(take_.parts[part].look, instance)) continue;
      next = part + 1;
      return part;
    }
    take_.parts.push_back({instance, ""});
    return take_.parts.size() - 1;
  }

  void addPoses(const std::vector<render::Instance>& instances) {
    std::vector<float> row = take_.poses.empty() ? std::vector<float>() : take_.poses.back();
    for (std::size_t p = bodies_; p < take_.parts.size(); ++p) row[p * Take::kPart + 7] = 0;
    std::size_t next = 0;
    for (const render::Instance& instance : instances) {
      const std::size_t part = partOf(instance, next);
      row.resize(take_.parts.size() * Take::kPart);
      float* at = &row[part * Take::kPart];
      Eigen::Map<render::Vec3f> place(at);
      place = instance.position;
      Eigen::Map<Eigen::Vector4f> turn(at + 3);
      const Eigen::Vector4f now = instance.orientation.normalized().coeffs();
      turn = turn.dot(now) < 0 ? -now : now;  // the nearer of the two that mean the same
      at[7] = instance.size.y();
    }
    take_.poses.push_back(std::move(row));
  }

  void addPositions(const std::vector<render::Surface>& surfaces) {
    std::vector<float> row;
    for (const render::Surface& surface : surfaces) {
      for (const render::Vec3f& position : surface.positions) append(row, position);
    }
    take_.positions.push_back(std::move(row));
  }

  void addCamera(render::Camera camera) {
    const scenes::CameraDef& def = simulation_.scene().camera;
    if (!def.keys.empty()) camera = scenes::keyCamera(simulation_, def);
    std::vector<float> row;
    append(row, camera.eye);
    append(row, camera.target);
    row.push_back(camera.fieldOfViewDegrees);
    const auto& poses = simulation_.world().bodies().pose;
    append(row, scenes::followed(simulation_, def, poses).cast<float>());
    take_.cameras.push_back(std::move(row));
  }

  void addLabels() {
    std::vector<float> row;
    for (const render::Label& label : scenes::labels(simulation_)) {
      append(row, label.at);
      row.push_back(label.text.empty() ? 0.0f : 1.0f);
    }
    take_.labelPlaces.push_back(std::move(row));
  }

  void addLayer(std::size_t index, const render::Picture& scenery) {
    TakeLayer& layer = take_.layers[index];
    std::vector<TakeStroke>& strokes = layer.frames.emplace_back();
    if (layer.strokes > kMostStrokes) return;
    scenes::ViewOptions options = options_;
    options.overlays = {};
    options.overlays.*kLayers[index].second = true;
    render::Picture picture;
    picture.camera = scenery.camera;
    scenes::drawOverlays(simulation_, options, scenery.focusRadius, picture);
    layer.strokes += picture.lines.size() + picture.dots.size();
    for (const render::Line& line : picture.lines) {
      strokes.push_back({line.from, line.to, styleOf(layer, {line.color, line.width, line.arrow})});
    }
    for (const render::Dot& dot : picture.dots) {
      strokes.push_back({dot.at, dot.at, styleOf(layer, {dot.color, dot.diameter, false})});
    }
  }

  static std::size_t styleOf(TakeLayer& layer, const TakeStyle& style) {
    const auto found = std::find(layer.styles.begin(), layer.styles.end(), style);
    if (found == layer.styles.end()) layer.styles.push_back(style);
    return static_cast<std::size_t>(std::find(layer.styles.begin(), layer.styles.end(), style) -
                                    layer.styles.begin());
  }

  // Parts that came later were not there before.
  void dropLayers() {
    for (std::vector<float>& row : take_.poses) row.resize(take_.parts.size() * Take::kPart);
    for (const TakeLayer& layer : take_.layers) {
      if (layer.strokes > kMostStrokes) take_.missing.push_back(layer.name);
    }
    std::erase_if(take_.layers, [](const TakeLayer& layer) {
      return layer.strokes == 0 || layer.strokes > kMostStrokes;
    });
  }

  scenes::Simulation& simulation_;
  const Motion& motion_;
  scenes::ViewOptions options_;
  Take take_;
  std::size_t bodies_ = 0;  // of the parts
};

}  // namespace

std::span<const std::pair<const char*, bool scenes::Overlays::*>> takeLayers() { return kLayers; }

void requireRoom(const std::string& file, const scenes::Simulation& start, int frames) {
  scenes::MotionBounds bounds;
  bounds.include(start);
  const render::Picture picture = scenes::view(start, bounds, viewOptions(start.scene()), {});
  std::size_t numbers = picture.instances.size() * Take::kPart;
  for (const render::Surface& surface : picture.surfaces) numbers += 3 * surface.positions.size();
  frames = (frames + start.scene().film.every - 1) / start.scene().film.every;
  if (static_cast<double>(numbers) * frames <= kMostNumbers) return;
  throw scenes::InputError(fmt::format(
      "{}: {} frames of {} numbers are more than the {:g} that a file to take along holds; "
      "--set duration=... or --set simulation.fps=... makes fewer frames",
      file, frames, numbers, kMostNumbers));
}

Take recordTake(scenes::Simulation& simulation, const Motion& motion) {
  return TakeRecorder(simulation, motion).record();
}

}  // namespace app
