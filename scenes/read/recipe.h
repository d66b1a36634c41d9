// What a scene file's tables become: steps that build a World, its names, its colours and its
// scripts.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "physics/world.h"
#include "scenes/read/table_reader.h"
#include "scenes/scene.h"
#include "scenes/simulation.h"
#include "scenes/view/palette.h"

namespace scenes {

// Points that are seen as a sheet: a cloth, the skin of a soft body.
struct SoftSurface {
  std::vector<physics::BodyId> nodes;
  std::vector<std::array<int, 3>> triangles;  // of nodes, counterclockwise from the front
  std::vector<Eigen::Vector2f> grid;          // by node, lines run through whole numbers; or edges
  double offset = 0;                          // m, of what is seen from the nodes
  render::Color front, back;
};

// Points that are seen as a tube.
struct SoftTube {
  std::vector<physics::BodyId> nodes;
  double radius = 0;  // m
  render::Color color;
};

// A part of a body of several shapes.
struct PartLook {
  std::shared_ptr<const render::Mesh> mesh;  // null but for convex ones
  std::optional<render::Color> color;        // absent: the body's
};

struct Simulation::Appearance {
  std::vector<render::Color> colors;                        // by BodyId
  std::vector<std::shared_ptr<const render::Mesh>> meshes;  // by BodyId, null but for convex bodies
  std::map<physics::BodyId, std::vector<PartLook>> parts;   // of bodies of several shapes
  std::vector<bool> hidden;                                 // by BodyId, drawn as part of these:
  std::vector<SoftSurface> surfaces;
  std::vector<SoftTube> tubes;
};

// Drives of one figure that follow poses over time.
struct PoseScript {
  struct Key {
    double time = 0;                     // s
    std::vector<physics::Quat> targets;  // one per drive
    physics::Pose root{};  // of the first bone, from where it starts: its place, and its turn
  };
  std::vector<int> drives;
  std::vector<Key> keys;      // times increase
  bool repeat = false;        // from the first key again after the last
  bool isCaptured = false;    // straight from key to key; else each is come to smoothly
  physics::BodyId root = -1;  // of a bone that goes where its keys say; -1: none
  physics::Pose start;        // its own
};

// The target of an arm over time, or the body that it is.
struct ArmScript {
  struct Key {
    double time = 0;  // s
    physics::Vec3 at = physics::Vec3::Zero();
    bool jump =
        false;  // the target is here from `time` on; else it has come smoothly from the last
  };
  int arm = -1;
  std::vector<Key> keys;        // times increase
  physics::BodyId follow = -1;  // the target is where this body will be if it goes on as it is
};

// A world under construction and all that goes with it.
struct Built {
  explicit Built(const physics::Settings& settings);
  physics::World world;
  std::vector<std::string> names;              // by BodyId
  std::map<std::string, physics::BodyId> ids;  // names, and second names such as "chain.end"
  Simulation::Appearance appearance;
  std::vector<PoseScript> scripts;
  std::vector<ArmScript> armScripts;
  std::map<physics::BodyId, physics::Pose> frames;  // the file's frame of a body in its own, where
                                                    // it is another
  int families = 0;                                 // hues given out so far

  // Names and colours the body; throws std::invalid_argument where the name is taken.
  void name(physics::BodyId body, const std::string& name, const render::Color& color);
  // `toFile`: the body's own frame, of its centre of mass and principal axes, in the file's.
  void place(physics::BodyId body, const physics::Pose& toFile);
  void alias(physics::BodyId body, const std::string& name);
  // "name.0", "name.1", ... in the colours of a family of its own, or all in one.
  void nameAll(const std::vector<physics::BodyId>& bodies, const std::string& name, Pattern pattern,
               const std::optional<render::Color>& color);
};

using Step = std::function<void(Built&)>;

struct Origin {  // the table that a step was read from
  std::string word;
  Place place;
};

struct Scene::Content {
  std::vector<Step> steps;
  std::vector<Origin> origins;  // one per step
  Value tree;                   // the file with every override
};

// Collects steps. Each runs at once on a trial world, so that what the World refuses is reported at
// the place in the file, and so that constraints find the bodies' names.
class Recipe {
 public:
  Recipe(const Scene& scene, Context& context);  // `context` gets to know the bodies' names
  Recipe(const Recipe&) = delete;
  void add(const TableReader& reader, Step step);
  const Built& trial() const { return trial_; }
  unsigned nextSeed();  // a seed for each generator, from the scene's
  Scene::Content take() { return std::move(content_); }

 private:
  Built trial_;
  Scene::Content content_;
  unsigned seed_;
};

// A word of the scene file that stands for an array of tables.
struct Word {
  const char* name;
  void (*read)(TableReader& reader, Recipe& recipe);
};
std::span<const Word> bodyWords();        // body, and every generator
std::span<const Word> constraintWords();  // read after all bodies have their names

void readNoContact(TableReader& reader, Recipe& recipe);  // read_pairs.cpp

// The name of an element: its `name`, else its word.
std::string readName(TableReader& reader, const std::string& otherwise);

}  // namespace scenes
