// MJCF: <compiler>, <option>, <default>, and orientations.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

using physics::Quat;
using physics::Vec3;

constexpr int kMostClasses = 10000;

Vec3 directionOf(const Tag& tag, const char* key, const Vec3& direction) {
  if (!(direction.norm() > 1e-12)) tag.fail(fmt::format("{}: expected a direction", key));
  return direction.normalized();
}

Quat fromEuler(const Vec3& angles, const std::string& sequence) {
  Quat q = Quat::Identity();
  for (int k = 0; k < 3; ++k) {
    const char letter = sequence[static_cast<std::size_t>(k)];
    const bool turnsWith = letter >= 'x';  // lower case: about axes that turn with what is turned
    const Quat turn =
        physics::exponential(angles[k] * Vec3::Unit((turnsWith ? letter - 'x' : letter - 'X')));
    q = turnsWith ? q * turn : turn * q;
  }
  return q;
}

Quat fromAxes(const Tag& tag, const std::vector<double>& n) {
  const Vec3 x = directionOf(tag, "xyaxes", {n[0], n[1], n[2]});
  const Vec3 given{n[3], n[4], n[5]};
  const Vec3 y = directionOf(tag, "xyaxes", given - given.dot(x) * x);
  physics::Mat3 turn;
  turn << x, y, x.cross(y);
  return Quat(turn);
}

Quat orientationOf(const Tag& tag, const MjcfCompiler& compiler) {
  const std::vector<double> quat = tag.numbers("quat", 4), axis = tag.numbers("axisangle", 4),
                            axes = tag.numbers("xyaxes", 6), z = tag.numbers("zaxis", 3),
                            euler = tag.numbers("euler", 3);
  const std::size_t given = quat.size() + axis.size() + axes.size() + z.size() + euler.size();
  for (const auto* one : {&quat, &axis, &axes, &z, &euler}) {
    if (!one->empty() && one->size() != given) tag.fail("expected one orientation, got several");
  }
  if (!axis.empty()) {
    const Vec3 n = directionOf(tag, "axisangle", {axis[0], axis[1], axis[2]});
    return physics::exponential(axis[3] * compiler.angle * n);
  }
  if (!axes.empty()) return fromAxes(tag, axes);
  if (!z.empty()) {
    const Vec3 n = directionOf(tag, "zaxis", {z[0], z[1], z[2]});
    return physics::turnBetween(Vec3::UnitZ(), n);
  }
  if (!euler.empty()) {
    return fromEuler(compiler.angle * Vec3(euler[0], euler[1], euler[2]), compiler.eulerSequence);
  }
  if (quat.empty()) return Quat::Identity();
  const Quat q(quat[0], quat[1], quat[2], quat[3]);
  if (!(q.norm() > 1e-12)) tag.fail("quat: expected a quaternion that is not zero");
  return q.normalized();
}

void readOneCompiler(const Tag& tag, Mjcf& mjcf) {
  MjcfCompiler& c = mjcf.compiler;
  static constexpr const char* kAngles[] = {"degree", "radian"};
  static constexpr const char* kInertias[] = {"auto", "true", "false"};
  if (tag.has("angle")) c.angle = tag.choice("angle", kAngles, "") == "radian" ? 1 : M_PI / 180;
  c.autoLimits = tag.flag("autolimits", c.autoLimits);
  c.eulerSequence = tag.text("eulerseq", c.eulerSequence);
  std::string letters = c.eulerSequence;
  for (char& letter : letters) letter = static_cast<char>(std::tolower(letter));
  if (letters.size() != 3 || letters.find_first_not_of("xyz") != std::string::npos) {
    tag.fail(fmt::format("eulerseq: expected three of x y z, got '{}'", c.eulerSequence));
  }
  if (tag.has("inertiafromgeom")) {
    const std::string word = tag.choice("inertiafromgeom", kInertias, "auto");
    c.inertia = word == "auto"   ? MjcfCompiler::Inertia::kAuto
                : word == "true" ? MjcfCompiler::Inertia::kParts
                                 : MjcfCompiler::Inertia::kStated;
  }
  const double total = tag.number("settotalmass", -1);
  if (total > 0) c.totalMass = total;
  const std::string assets = tag.text("assetdir", "");
  if (!assets.empty()) c.meshFolder = assets;
  c.meshFolder = tag.text("meshdir", c.meshFolder);
  tag.text("texturedir");
  if (tag.text("coordinate", "local") != "local") {
    tag.fail("coordinate: expected 'local': MuJoCo has given up the others");
  }
}

struct DefaultsReader {
  Mjcf& mjcf;

  void read(const XmlElement& element, const MjcfClass* parent, const std::string& name) {
    mjcf.survey.seen(element);
    mjcf.survey.asked("default", "class");
    MjcfClass& own = mjcf.classes[name];
    if (own.parent == nullptr && parent != &own) own.parent = parent;
    if (mjcf.classes.size() > kMostClasses) {
      fail(mjcf.survey.context(), element.place, "<default>: too many classes");
    }
    for (const XmlElement& child : element.children) {
      if (child.tag == "default") {
        const XmlAttribute* inner = child.find("class");
        if (inner == nullptr || inner->text.empty() || mjcf.classes.contains(inner->text)) {
          fail(mjcf.survey.context(), child.place, "<default>: expected a class with a new name");
        }
        read(child, &mjcf.classes[name], inner->text);
      } else {
        mjcf.classes[name].elements.push_back(&child);
      }
    }
  }
};

}  // namespace

physics::Pose poseOf(const Tag& tag, const Mjcf& mjcf) {
  return {tag.vector("pos", Vec3::Zero()), orientationOf(tag, mjcf.compiler)};
}

void readCompiler(Mjcf& mjcf) {
  for (const XmlElement* element : childrenOf(*mjcf.root, "compiler", mjcf.survey)) {
    readOneCompiler(Tag(*element, mjcf.survey), mjcf);
  }
}

void readOptions(Mjcf& mjcf) {
  for (const XmlElement* element : childrenOf(*mjcf.root, "option", mjcf.survey)) {
    const Tag tag(*element, mjcf.survey);
    mjcf.model.gravity = tag.vector("gravity", mjcf.model.gravity);
  }
}

void readDefaults(Mjcf& mjcf) {
  mjcf.classes["main"];
  for (const XmlElement* element : childrenOf(*mjcf.root, "default", mjcf.survey)) {
    DefaultsReader{mjcf}.read(*element, nullptr, "main");
  }
}

std::string classOf(const XmlElement& element, const Mjcf& mjcf, const std::string& around) {
  const XmlAttribute* own = element.find("class");
  if (own == nullptr) return around.empty() ? "main" : around;
  if (mjcf.classes.contains(own->text)) return own->text;
  std::vector<std::string> known;
  for (const auto& [name, one] : mjcf.classes) known.push_back(name);
  fail(mjcf.survey.context(), element.place,
       fmt::format("<{}>: no class '{}'{}", element.tag, own->text, didYouMean(own->text, known)));
}

Tag tagOf(const XmlElement& element, Mjcf& mjcf, const std::string& around) {
  mjcf.survey.asked(element.tag, "class");
  std::vector<const XmlElement*> standard;
  const std::string kind = element.tag == "spatial" ? "tendon" : element.tag;
  const MjcfClass* from = &mjcf.classes.at(classOf(element, mjcf, around));
  for (; from != nullptr; from = from->parent) {
    for (auto it = from->elements.rbegin(); it != from->elements.rend(); ++it) {
      if ((*it)->tag != kind) continue;
      standard.push_back(*it);
      mjcf.survey.seen(**it);
    }
  }
  return {element, mjcf.survey, std::move(standard)};
}

}  // namespace scenes
