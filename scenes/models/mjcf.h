// What the pieces of the MJCF reader share:
// https://mujoco.readthedocs.io/en/stable/XMLreference.html
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenes/models/mass.h"
#include "scenes/models/model.h"
#include "scenes/models/tag.h"

namespace scenes {

struct MjcfCompiler {
  double angle = 3.14159265358979323846 / 180;  // rad, of an angle that is 1
  std::string eulerSequence = "xyz";
  bool autoLimits = true;  // a range is a limit
  enum class Inertia { kAuto, kParts, kStated } inertia = Inertia::kAuto;
  std::string meshFolder;
  std::optional<double> totalMass;  // kg, to which the masses are scaled
};

// Attributes that elements of a class have where they state none.
struct MjcfClass {
  const MjcfClass* parent = nullptr;
  std::vector<const XmlElement*> elements;
};

struct MjcfMesh {
  Place place;
  std::vector<physics::Vec3> points;  // empty: read when a geom asks for it
  std::string path;
  bool read = true;  // false: it is made in a way that is not read
  physics::Vec3 scale = physics::Vec3::Ones();
  physics::Pose reference;  // of the points' frame
};

struct MjcfHeights {
  physics::Vec2 extent = physics::Vec2::Ones();  // m
  std::vector<std::vector<double>> rows;         // m, as ours have them; empty: too many
  int rowCount = 0, columnCount = 0;
};

struct MjcfSite {
  int link = kWorldLink;
  physics::Vec3 at = physics::Vec3::Zero();  // in the link's frame
};

struct MjcfMaterial {
  std::optional<std::array<double, 4>> rgba;
};

struct MjcfJointRef {
  int link = 0, joint = 0;  // of the link's joints
};

// One <mujoco>: a file with those that it includes. Models that it attaches have their own, and
// share the model that comes of it.
struct Mjcf {
  ModelSurvey& survey;
  Model& model;
  std::string folder;              // of the main file
  std::string prefix{}, suffix{};  // around the names of what is attached or repeated
  MjcfCompiler compiler{};
  std::map<std::string, MjcfClass> classes{};
  std::map<std::string, MjcfMesh> meshes{};
  std::map<std::string, MjcfHeights> heights{};
  std::map<std::string, MjcfMaterial> materials{};
  std::map<std::string, std::shared_ptr<Mjcf>> attachable{};
  std::map<std::string, int> links{};
  std::map<std::string, MjcfSite> sites{};
  std::map<std::string, std::vector<std::string>> repeated{};  // suffixes of a site, as it is named
  std::size_t actuators = 0;                                   // read so far
  std::map<std::string, MjcfJointRef> joints{};
  std::set<std::string> freeJoints{};
  bool makesBodies = false;  // by <composite> or <flexcomp>, which are not read
  std::shared_ptr<XmlElement> root{};

  std::string named(const std::string& name) const { return prefix + name + suffix; }
};

// The element with the defaults of its class, or of the class around it.
// Defaults of a <spatial> are those of a <tendon>.
Tag tagOf(const XmlElement& element, Mjcf& mjcf, const std::string& around = "");
std::string classOf(const XmlElement& element, const Mjcf& mjcf, const std::string& around);

physics::Pose poseOf(const Tag& tag, const Mjcf& mjcf);  // pos, quat, euler and the others

// In the order in which a file is read.
void includeXml(XmlElement& root, const std::string& folder, ModelSurvey& survey);
void readCompiler(Mjcf& mjcf);
void readOptions(Mjcf& mjcf);  // of the main file: those that are attached follow it
void readDefaults(Mjcf& mjcf);
void readAssets(Mjcf& mjcf);
void readBodies(Mjcf& mjcf);
void readActuators(Mjcf& mjcf);
void readPairs(Mjcf& mjcf);  // <contact>, <equality>
void readTendons(Mjcf& mjcf);
// Starts in the <key> of this name; empty: as the bodies are drawn, and the names are told.
void readKeyframes(Mjcf& mjcf, const std::string& wanted);

void readHeightField(const XmlElement& element, Mjcf& mjcf);
// False: one that is not read.
bool readHeightShape(const Tag& tag, const Mjcf& mjcf, ModelPart& part);
// A range where it is one: none where it is absent, or said not to limit.
std::optional<std::array<double, 2>> rangeOf(const Tag& tag, const MjcfCompiler& compiler,
                                             double unit);

// A geom, in its body's frame; none where its kind is not read.
std::optional<ModelPart> readGeom(const Tag& tag, Mjcf& mjcf);
ModelJoint readJoint(const Tag& tag, const Mjcf& mjcf);
ModelInertial readInertial(const Tag& tag, const Mjcf& mjcf);

// All of a file that is to be attached, without its bodies.
std::shared_ptr<Mjcf> openMjcf(XmlElement root, const std::string& folder, ModelSurvey& survey,
                               Model& model, int depth);
Model readMjcf(XmlElement root, const std::string& path, ModelSurvey& survey,
               const std::string& keyframe = "");

}  // namespace scenes
