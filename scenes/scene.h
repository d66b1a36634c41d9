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

// Names of bodies and patterns such as "stack.*": a body that one of them matches is meant.
struct Patterns {
  static constexpr const char* kTypeWord = "a name or a pattern | several";
  std::vector<std::string> any;
  bool operator==(const Patterns&) const = default;
};
bool matches(const Patterns& patterns, const std::string& name);

struct CameraDef {
  // No keys: the camera looks along `direction` and fits the motion of everything that moves.
  std::vector<CameraKey> keys;
  physics::Vec3 direction{-0.5, -0.35, -1.0};
  double fieldOfViewDegrees = 35;
  Patterns fit{{"*"}};   // the bodies to fit
  Patterns follow;       // the bodies whose middle it moves with, from where it would stand
  double margin = 0.08;  // of the picture, left free on each side
};

struct LightDef {  // what is absent is as render::Light has it
  bool shadows = true;
  std::optional<physics::Vec3> direction;  // the way light travels
  std::optional<Eigen::Vector4f> color;    // sRGB
  std::optional<double> softnessDegrees;   // half the angle that the light is seen under
};

// How a film shows the time of the motion. A step of the simulation takes one frame of it, or a
// part of one where that is longer than a step, or than a moment while the shutter is open.
struct FilmDef {
  int fps = 0;                // of the film; 0: as many as the motion has
  double speed = 1;           // seconds of the motion in one of the film
  double shutterDegrees = 0;  // of 360 a frame that it is open; 0: no blur
  int every = 1;              // steps from one frame of the film to the next
  int moments = 1;            // and how many of them the shutter sees, from the frame's own on
};

struct LabelDef {                            // [[label]]
  std::string text, body;                    // no body: `at` is a place in the world
  physics::Vec3 at = physics::Vec3::Zero();  // m, from the body's centre
  std::optional<double> from, to;            // s
  double size = 18;                          // pixels of a picture of 720 lines
};

struct Overlays {  // drawn on request, off by default
  bool contacts = false, impulses = false, joints = false, centresOfMass = false;
  bool arms = false;  // all of an arm: its target, s_i to the tip, d_1j to the centres of mass
  bool armTargets = false, armAngles = false, armTips = false, armCentres = false;  // or some
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
  LightDef light;
  FilmDef film;
  std::vector<LabelDef> labels;
  std::optional<Eigen::Vector4f> background;  // sRGB; alpha 0: transparent
  GoldenDef golden;
  std::vector<Expectation> expectations;
  std::vector<std::string> effects;  // words that switch something on, for `dbd list`
  std::string text;                  // the file's text, for run.json's hash
  std::vector<std::string> overrides;
  std::vector<std::string> told;  // what of a model (MJCF, URDF) is not read, a line each

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

// Folders of the library and the assets: of $DBD_HOME, else of what comes with dbd
// (render/shipped.h).
std::string libraryFolder();
std::string assetFolder();

// What to say where a folder of shipped files holds none.
std::string nothingIn(const std::string& folder);

}  // namespace scenes
