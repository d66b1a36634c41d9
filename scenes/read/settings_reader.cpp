// [simulation] [gravity] [contact] [sleep] [camera] [overlays] [golden] [[expect]].
#include "scenes/read/settings_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "scenes/joined.h"
#include "scenes/measure/metrics.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

constexpr const char* kMethods[] = {
    "nonlinear_gauss_seidel", "direct",  "linear_gauss_seidel", "xpbd",
    "sequential_impulses",    "penalty", "penalty_explicit",    "small_steps"};
constexpr const char* kSteppings[] = {"paper", "static", "bdf2", "symmetric"};
constexpr const char* kRegularisations[] = {"compliance", "damping"};
constexpr const char* kInertias[] = {"plain", "spinning"};
constexpr const char* kRefreshes[] = {"substep", "iteration"};

// Of what was asked for, what the method does not look at.
void tellUnused(const TableReader& reader, Scene& scene) {
  const physics::Settings& settings = scene.settings;
  std::vector<std::string> words;
  if (settings.takesSmallSteps()) {
    for (const char* word :
         {"iterations", "max_iterations", "tolerance", "penalty_stiffness", "relaxation", "inertia",
          "inertia_refresh", "local_substeps", "local_tolerance"}) {
      if (reader.has(word)) words.emplace_back(word);
    }
  } else if (reader.has("accuracy")) {
    words.emplace_back("accuracy");
  }
  if (words.empty()) return;
  const bool isOne = words.size() == 1;
  scene.told.push_back(fmt::format("simulation: {} change{} nothing: {} does not look at {}",
                                   joined(words, ", "), isOne ? "s" : "", solverText(settings),
                                   isOne ? "it" : "them"));
}

void readSimulation(TableReader& reader, Scene& scene) {
  physics::Settings& settings = scene.settings;
  reader(Field{"fps", Unit::kNone, false, 1, 1e6}, scene.fps);
  reader(Field{"accuracy", Unit::kNone, false, 1e-12, 0.5}, settings.accuracy);
  reader(Field{"substeps", Unit::kNone, false, 1, 1e6}, settings.substeps);
  reader(Field{"iterations", Unit::kNone, false, 1, 1e6}, settings.iterations);
  reader(Field{"max_iterations", Unit::kNone, false, 0, 1e6}, settings.maxIterations);
  reader(Field{"tolerance", Unit::kMetre, false, 0}, settings.tolerance);
  reader(Field{"penalty_stiffness", Unit::kNone, false, 1e-6, 1e12}, settings.penaltyStiffness);
  reader(Field{"relaxation", Unit::kNone, false, 0.01, 1.99}, settings.relaxation);
  reader(Field{"regularisation", Unit::kNone, false, 0, 1e6}, settings.regularisation);
  reader(Field{"max_correction_speed", Unit::kNone, false, kPositive}, settings.maxCorrectionSpeed);
  reader(Field{"local_substeps"}, settings.localSubsteps);
  reader(Field{"local_tolerance", Unit::kMetre, false, kPositive}, settings.localTolerance);
  reader(Field{"leave_out"}, settings.leavesOut);
  reader(Field{"seed"}, scene.seed);
  settings.method = static_cast<physics::Method>(
      reader.choose("method", kMethods, static_cast<int>(settings.method)));
  settings.stepping = static_cast<physics::Stepping>(reader.choose("stepping", kSteppings, 0));
  settings.regularisationForm = static_cast<physics::Regularisation>(
      reader.choose("regularisation_form", kRegularisations, 0));
  settings.spinInertia = reader.choose("inertia", kInertias, 0) == 1;
  settings.refreshInertia = reader.choose("inertia_refresh", kRefreshes, 1) == 1;
  tellUnused(reader, scene);
}

void readContact(TableReader& reader, physics::Settings& settings) {
  physics::ContactSettings contact;
  bool enabled = true;
  reader(Field{"enabled"}, enabled);
  reader(Field{"friction"}, contact.friction);
  reader(Field{"restitution", Unit::kNone, false, 0, 1}, contact.restitution);
  reader(Field{"max_separation_speed", Unit::kNone, false, kPositive}, contact.maxSeparationSpeed);
  reader(Field{"margin", Unit::kMetre, false, 0}, contact.margin);
  settings.contact.reset();
  if (enabled) settings.contact = contact;
}

void readSleep(TableReader& reader, physics::Settings& settings) {
  physics::SleepSettings sleep;
  bool enabled = true;
  reader(Field{"enabled"}, enabled);
  reader(Field{"speed", Unit::kNone, false, 0}, sleep.speed);
  reader(Field{"time", Unit::kNone, false, kPositive}, sleep.time);
  settings.sleep.reset();
  if (enabled) settings.sleep = sleep;
}

// Ground, or a body or generator with friction or restitution of its own: such a scene means
// contacts.
bool asksForContact(const Value& root) {
  for (const Member& word : root.members) {
    for (const Value& element : word.value.items) {
      const Value* shape = element.find("shape");
      if (element.find("friction") != nullptr) return true;
      for (const char* ground : {"plane", "triangles", "heights"}) {
        if (shape != nullptr && shape->find(ground) != nullptr) return true;
      }
      if (element.find("restitution") != nullptr) return true;
    }
  }
  return false;
}

void readKey(const Value& value, const Spot& spot, CameraKey& key) {
  if (!value.isTable()) failExpected(spot, value, "a table { time, eye, target }");
  TableReader reader(value, spot.key, spot.context);
  reader(Field{"time", Unit::kNone, false, 0}, key.time);
  reader(Field{"eye", Unit::kPoint, true}, key.eye);
  reader(Field{"target", Unit::kPoint, true}, key.target);
  reader(Field{"field_of_view_degrees", Unit::kNone, false, 1, 150}, key.fieldOfViewDegrees);
  reader.finish();
  if ((key.eye - key.target).norm() < 1e-9) {
    reader.failAt("target", "expected a point away from 'eye'");
  }
}

void readKeys(TableReader& reader, CameraDef& camera) {
  const Value* keys = reader.take("keys");
  if (keys == nullptr) return;
  const Spot spot = reader.spot({"keys"});
  if (!keys->isArray() || keys->items.empty()) failExpected(spot, *keys, "an array of keys");
  for (const Value& item : keys->items) {
    CameraKey key;
    key.fieldOfViewDegrees = camera.fieldOfViewDegrees;
    readKey(item, spot, key);
    if (!camera.keys.empty() && key.time <= camera.keys.back().time) {
      fail(reader.context(), item.place,
           fmt::format("camera.keys: expected times that increase, got {} after {}", key.time,
                       camera.keys.back().time));
    }
    camera.keys.push_back(key);
  }
}

// An override may shorten the scene: frames past its end are an error of the file alone.
void readGolden(TableReader& reader, const Scene& scene, GoldenDef& golden) {
  reader(Field{"frames", Unit::kNone, true, 0}, golden.frames);
  reader(Field{"width", Unit::kNone, false, 16, 8192}, golden.width);
  reader(Field{"height", Unit::kNone, false, 16, 8192}, golden.height);
  reader(Field{"hud"}, golden.hud);
  reader(Field{"state_hash"}, golden.stateHash);
  const auto isHex = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  const std::string& hash = golden.stateHash;
  if (!hash.empty() && (hash.size() != 16 || !std::all_of(hash.begin(), hash.end(), isHex))) {
    reader.failAt("state_hash", "expected 16 hex digits, as dbd simulate --hash prints them");
  }
  if (golden.frames.empty()) reader.failAt("frames", "expected at least one frame");
  for (size_t i = 0; i < golden.frames.size(); ++i) {
    if (i > 0 && golden.frames[i] <= golden.frames[i - 1]) {
      reader.failAt("frames", "expected frames in increasing order");
    }
    if (scene.overrides.empty() && golden.frames[i] >= scene.frameCount()) {
      reader.failAt("frames", fmt::format("expected frames below {}, got {}", scene.frameCount(),
                                          golden.frames[i]));
    }
  }
}

void readExpectation(TableReader& reader, Scene& scene) {
  Expectation expectation;
  expectation.line = reader.table().place.line;
  expectation.column = reader.table().place.column;
  expectation.file = reader.table().place.file;
  readMetric(reader, expectation.metric, expectation.body);
  reader(Field{"at_most"}, expectation.atMost);
  reader(Field{"at_least"}, expectation.atLeast);
  reader(Field{"from", Unit::kNone, false, 0}, expectation.from);
  reader(Field{"to", Unit::kNone, false, 0}, expectation.to);
  if (!expectation.atMost && !expectation.atLeast && expectation.metric != "finite") {
    reader.failHere("expected 'at_most' or 'at_least'");
  }
  if (expectation.atMost && expectation.atLeast && *expectation.atMost < *expectation.atLeast) {
    reader.failAt("at_most",
                  fmt::format("expected a number >= at_least = {}, or nothing can be both",
                              *expectation.atLeast));
  }
  const double end = expectation.to.value_or(scene.overrides.empty() ? scene.duration : 1e300);
  if (expectation.from.value_or(0) > end) {
    reader.failAt("from", fmt::format("expected a time <= {} s, the end of the span", end));
  }
  scene.expectations.push_back(expectation);
}

}  // namespace

const char* wordOf(physics::Method method) { return kMethods[static_cast<int>(method)]; }
const char* wordOf(physics::Stepping stepping) { return kSteppings[static_cast<int>(stepping)]; }

std::string solverText(const physics::Settings& s) {
  const bool isStepping = s.method == physics::Method::kSmallSteps && !s.takesSmallSteps();
  return isStepping ? fmt::format("stepping = \"{}\"", wordOf(s.stepping))
                    : fmt::format("method = \"{}\"", wordOf(s.method));
}

std::string substepsText(const physics::Settings& s) {
  if (s.choosesSubsteps()) return "substeps as each island asks";
  return fmt::format("{} substep{}", s.substepCount(), s.substepCount() == 1 ? "" : "s");
}

void readCamera(TableReader& reader, CameraDef& camera) {
  reader(Field{"field_of_view_degrees", Unit::kNone, false, 1, 150}, camera.fieldOfViewDegrees);
  reader(Field{"direction", Unit::kDirection}, camera.direction);
  reader(Field{"fit"}, camera.fit);
  reader(Field{"follow"}, camera.follow);
  if (reader.has("follow") && !reader.has("fit")) camera.fit = camera.follow;
  reader(Field{"margin", Unit::kNone, false, 0, 10}, camera.margin);
  CameraKey fixed;
  reader(Field{"eye", Unit::kPoint, reader.has("target")}, fixed.eye);
  reader(Field{"target", Unit::kPoint, reader.has("eye")}, fixed.target);
  readKeys(reader, camera);
  for (const char* other : {"keys", "direction", "fit"}) reader.atMostOne("eye", other);
  if (reader.has("eye")) {
    fixed.fieldOfViewDegrees = camera.fieldOfViewDegrees;
    if (fixed.eye == fixed.target) reader.failAt("target", "expected a point away from 'eye'");
    camera.keys.push_back(fixed);
  }
}

void readOverlays(TableReader& reader, Overlays& overlays) {
  reader(Field{"contacts"}, overlays.contacts);
  reader(Field{"impulses"}, overlays.impulses);
  reader(Field{"joints"}, overlays.joints);
  reader(Field{"centres_of_mass"}, overlays.centresOfMass);
  reader(Field{"arms"}, overlays.arms);
  reader(Field{"arm_targets"}, overlays.armTargets);
  reader(Field{"arm_angles"}, overlays.armAngles);
  reader(Field{"arm_tips"}, overlays.armTips);
  reader(Field{"arm_centres"}, overlays.armCentres);
  reader(Field{"vectors"}, overlays.vectors);
}

void readMetric(TableReader& reader, std::string& word, std::string& body, const char* metricKey,
                const char* bodyKey) {
  reader(Field{metricKey, Unit::kNone, true}, word);
  reader(Field{bodyKey}, body);
  const Metric* metric = findMetric(word);
  if (metric == nullptr) {
    reader.failAt(metricKey,
                  fmt::format("unknown metric '{}'{}", word, didYouMean(word, metricNames())));
  }
  const bool needsBody = metric->about != Metric::About::kScene;
  if (needsBody && !reader.has(bodyKey)) {
    reader.failAt(metricKey, fmt::format("expected a '{}' as well: {} is {}", bodyKey, metric->name,
                                         metric->meaning));
  }
  if (!needsBody && reader.has(bodyKey)) {
    reader.failAt(bodyKey, fmt::format("expected none: {} is {}", metric->name, metric->meaning));
  }
}

void readSettings(TableReader& root, Scene& scene) {
  readTable(root, "simulation", [&](TableReader& reader) { readSimulation(reader, scene); });
  readFilm(root, scene);
  scene.settings.dt = 1.0 / scene.fps;
  readTable(root, "gravity", [&](TableReader& reader) {
    scene.settings.gravity = physics::Vec3(0, -9.81, 0);
    reader(Field{"acceleration"}, scene.settings.gravity);
  });
  if (asksForContact(root.table())) scene.settings.contact.emplace();
  readTable(root, "contact", [&](TableReader& reader) { readContact(reader, scene.settings); });
  readTable(root, "sleep", [&](TableReader& reader) { readSleep(reader, scene.settings); });
}

void readPresentation(TableReader& root, Scene& scene) {
  readTable(root, "camera", [&](TableReader& reader) { readCamera(reader, scene.camera); });
  readLooks(root, scene);
  readTable(root, "overlays", [&](TableReader& reader) { readOverlays(reader, scene.overlays); });
  readTable(root, "golden", [&](TableReader& reader) { readGolden(reader, scene, scene.golden); });
  readTables(root, "expect", [&](TableReader& reader) { readExpectation(reader, scene); });
}

}  // namespace scenes
