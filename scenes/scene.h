// A scene: the checked description that a TOML file becomes, and where to find such files.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/world.h"
#include "scenes/read/input_error.h"

namespace scenes {

struct Glossary;  // glossary.h

struct Expectation {  // [[expect]]
  std::string
      metric;  // joint_error, energy_drift, momentum_drift, overlap, max_speed, finite, height, ...
  std::string body;  // where the metric is one body's
  std::optional<double> atMost, atLeast;
  std::optional<double> from, to;  // s, the span it must hold in; absent: the whole run
  int line = 0, column = 0;
  std::string file;  // where it is not the scene's own: one that it includes
};

struct CameraKey {
  double time = 0;  // s
  physics::Vec3 eye = physics::Vec3::Zero(), target = physics::Vec3::Zero();
  double fieldOfViewDegrees = 35;
};

struct CameraDef {
  // No keys: the camera looks along `direction` and fits the motion of everything that moves.
  std::vector<CameraKey> keys;
  physics::Vec3 direction{-0.5, -0.35, -1.0};
  double fieldOfViewDegrees = 35;
  std::string fit = "*";  // the bodies to fit: a name or a pattern such as "stack.*"
  double margin = 0.08;   // of the picture, left free on each side
};

struct Overlays {  // drawn on request, off by default
  bool contacts = false, impulses = false, joints = false, centresOfMass = false;
  bool arms = false;  // all of an arm: its target, s_i to the tip, d_1j to the centres of mass
  bool armTargets = false, armTips = false, armCentres = false;  // or one of them
  bool vectors = false;  // lever arms, axes, errors and normals with their letters
};

struct GoldenDef {  // [golden]
  std::vector<int> frames;
  int width = 480, height = 270;
  bool hud = false;
  std::string stateHash;  // of the last golden frame, 16 hex digits; empty: not recorded yet
};

// All that was read, with defaults filled in and every override applied. What the bodies and
// constraints are is kept behind `content`, which Simulation builds from.
struct Scene {
  std::string name;  // file name without .toml
  std::string path;
  std::string title;
  std::string description;
  double duration = 10;  // s
  int fps = 60;
  unsigned seed = 1;
  physics::Settings settings;
  CameraDef camera;
  Overlays overlays;
  bool shadows = true;  // [light]
  GoldenDef golden;
  std::vector<Expectation> expectations;
  std::vector<std::string> effects;  // words that switch something on, for `dbd list`
  std::string text;                  // the file's text, for run.json's hash
  std::vector<std::string> overrides;

  struct Content;
  std::shared_ptr<const Content> content;

  int frameCount()
      const;  // frames 0..frameCount()-1, frame k at k/fps; duration rounded to whole frames
};

// `scene` is a name in the library or a path. Throws InputError, with the nearest name for an
// unknown one. Each override is "key=value" (simulation.iterations=32, body.ball.mass=3,
// gravity.acceleration=[0,-1,0]), typed and checked as the file is.
Scene readScene(const std::string& scene, std::span<const std::string> overrides = {});
Scene parseScene(const std::string& text, const std::string& path,
                 std::span<const std::string> overrides = {}, Glossary* noted = nullptr);

std::vector<std::string> libraryScenes();  // names, sorted

// Folders of the library and the assets: $DBD_HOME, else beside the program, else the source tree.
std::string libraryFolder();
std::string assetFolder();

// What to say where a folder of shipped files holds none.
std::string nothingIn(const std::string& folder);

}  // namespace scenes
