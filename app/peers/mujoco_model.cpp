// Writes the model that MuJoCo reads. What is not written is at its defaults: solver, contacts
// softened by solref and solimp, a friction pyramid.
#include "app/peers/mujoco_model.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <set>

#include "physics/base/rotation.h"

namespace app {

namespace {

using physics::BodyId;
using physics::Pose;
using physics::Quat;
using physics::Vec3;
using Kind = PeerJoint::Kind;

// What MuJoCo reserves room for, as the square of its rows: its own guess is too little for a heap.
constexpr int kContactsOfABody = 13, kRowsOfAContact = 4;

const Quat kZToY(std::sqrt(0.5), -std::sqrt(0.5), 0, 0);  // its capsules and cylinders lie along z

std::string text(const Vec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}
std::string text(const Quat& q) {
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w(), q.x(), q.y(), q.z());
}

struct Geometry {
  std::string words;  // type and size
  Vec3 at = Vec3::Zero();
  Quat turn = Quat::Identity();
};

Geometry geometryOf(const physics::PointShape&, BodyId) { return {}; }
Geometry geometryOf(const physics::Box& s, BodyId) {
  return {fmt::format(R"(type="box" size="{}")", text(Vec3(s.size / 2))), {}, Quat::Identity()};
}
Geometry geometryOf(const physics::Sphere& s, BodyId) {
  return {fmt::format(R"(type="sphere" size="{:.17g}")", s.radius), {}, Quat::Identity()};
}
Geometry geometryOf(const physics::Capsule& s, BodyId) {
  return {
      fmt::format(R"(type="capsule" size="{:.17g} {:.17g}")", s.radius, s.length / 2), {}, kZToY};
}
Geometry geometryOf(const physics::Cylinder& s, BodyId) {
  return {
      fmt::format(R"(type="cylinder" size="{:.17g} {:.17g}")", s.radius, s.length / 2), {}, kZToY};
}
Geometry geometryOf(const physics::Convex&, BodyId i) {
  return {fmt::format(R"(type="mesh" mesh="{}")", mujocoName(i)), {}, Quat::Identity()};
}
Geometry geometryOf(const physics::Plane& s, BodyId) {
  return {R"(type="plane" size="0 0 1")", s.offset * s.normal,
          physics::turnBetween(Vec3::UnitZ(), s.normal)};
}

// Blueprints refuse these.
Geometry geometryOf(const physics::Compound&, BodyId) { return {}; }
Geometry geometryOf(const physics::Triangles&, BodyId) { return {}; }

class Writer {
 public:
  Writer(const physics::World& world, const Blueprint& plan, const Forest& forest)
      : bodies_(world.bodies()), settings_(world.settings()), plan_(plan), forest_(forest) {}

  std::string write() {
    const int contacts = kContactsOfABody * bodies_.size();
    out_ = "<mujoco><compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n";
    out_ +=
        fmt::format("<option gravity=\"{}\"/>\n", text(settings_.gravity.value_or(Vec3::Zero())));
    out_ +=
        fmt::format("<size nconmax=\"{}\" njmax=\"{}\"/>\n", contacts, kRowsOfAContact * contacts);
    writeMeshes();
    out_ += "<worldbody>\n";
    writeTrees();
    for (BodyId i = 1; i < bodies_.size(); ++i) {
      if (!written_.contains(i)) writeBody(i, Pose{}, isDynamic(i) ? "<freejoint/>" : "", {});
    }
    out_ += "</worldbody>\n<contact>\n";
    for (const auto& [a, b] : plan_.ignored) {
      if (a == physics::kWorldBody) continue;
      out_ += fmt::format("<exclude body1=\"{}\" body2=\"{}\"/>\n", mujocoName(a), mujocoName(b));
    }
    return out_ + "</contact></mujoco>\n";
  }

 private:
  bool isDynamic(BodyId i) const { return bodies_.motion[i] == physics::Motion::kDynamic; }

  void writeMeshes() {
    out_ += "<asset>\n";
    for (BodyId i = 1; i < bodies_.size(); ++i) {
      const auto* convex = std::get_if<physics::Convex>(&bodies_.shape[i]);
      if (convex == nullptr) continue;
      out_ += fmt::format("<mesh name=\"{}\" vertex=\"", mujocoName(i));
      for (const Vec3& p : convex->hull->vertices) out_ += text(p) + " ";
      out_ += "\"/>\n";
    }
    out_ += "</asset>\n";
  }

  void writeTrees() {
    for (const Tree& tree : forest_.trees) {
      const auto links = [&](int parent, const Pose& pose) { writeLinks(tree, parent, pose); };
      if (tree.isFixed) {
        links(-1, Pose{});
      } else {
        writeBody(tree.base, Pose{}, "<freejoint/>", [&] { links(-1, bodies_.pose[tree.base]); });
      }
    }
  }

  void writeLinks(const Tree& tree, int parent, const Pose& pose) {
    for (std::size_t k = 0; k < tree.links.size(); ++k) {
      const TreeLink& link = tree.links[k];
      if (link.parent != parent) continue;
      writeBody(link.body, pose, jointText(*link.joint, link.side),
                [&] { writeLinks(tree, static_cast<int>(k), bodies_.pose[link.body]); });
    }
  }

  // The turn that is limited is that of the second body of the joint.
  static std::string jointText(const PeerJoint& joint, int side) {
    const char* type = joint.kind == Kind::kBall    ? "ball"
                       : joint.kind == Kind::kHinge ? "hinge"
                                                    : "slide";
    std::string words =
        fmt::format(R"(<joint type="{}" pos="{}")", type, text(joint.anchors[side]));
    if (joint.kind != Kind::kBall) words += fmt::format(R"( axis="{}")", text(joint.axes[side]));
    if (joint.limits) {
      const auto [low, high] = *joint.limits;
      words += fmt::format(R"( limited="true" range="{:.17g} {:.17g}")", side == 1 ? low : -high,
                           side == 1 ? high : -low);
    }
    return words + "/>";
  }

  void writeBody(BodyId i, const Pose& parent, const std::string& joint,
                 const std::function<void()>& children) {
    written_.insert(i);
    const Pose& pose = bodies_.pose[i];
    const Quat back = parent.q.conjugate();
    out_ += fmt::format("<body name=\"{}\" pos=\"{}\" quat=\"{}\">{}\n", mujocoName(i),
                        text(Vec3(back * (pose.x - parent.x))), text(Quat(back * pose.q)), joint);
    if (isDynamic(i)) {
      out_ += fmt::format("<inertial pos=\"0 0 0\" mass=\"{:.17g}\" diaginertia=\"{}\"/>\n",
                          bodies_.mass[i], text(bodies_.inertia[i]));
    }
    const Geometry geometry =
        std::visit([&](const auto& shape) { return geometryOf(shape, i); }, bodies_.shape[i]);
    if (!geometry.words.empty() && settings_.contact) {
      out_ += fmt::format("<geom {} pos=\"{}\" quat=\"{}\" friction=\"{:.17g}\"/>\n",
                          geometry.words, text(geometry.at), text(geometry.turn),
                          bodies_.friction[i].dynamicCoefficient);
    }
    if (children) children();
    out_ += "</body>\n";
  }

  const physics::Bodies& bodies_;
  const physics::Settings& settings_;
  const Blueprint& plan_;
  const Forest& forest_;
  std::set<BodyId> written_;
  std::string out_;
};

std::string bodyRefusal(const physics::World& world) {
  const physics::Bodies& b = world.bodies();
  for (BodyId i = 1; i < b.size(); ++i) {
    if (b.motion[i] == physics::Motion::kKinematic) {
      return "MuJoCo has no body that is moved and carries others along";
    }
    if (isMovable(world, i) && !(b.inertia[i].minCoeff() > 0)) {
      return "MuJoCo has no body without inertia";
    }
    if (world.settings().contact &&
        b.friction[i].dynamicCoefficient != b.friction[1].dynamicCoefficient) {
      return "MuJoCo takes the larger friction of two bodies, which differ here";
    }
  }
  return "";
}

}  // namespace

std::string mujocoName(BodyId body) { return fmt::format("b{}", body); }

std::string mujocoRefusal(const physics::World& world, const Blueprint& plan,
                          const Forest& forest) {
  if (world.settings().contact && world.settings().contact->restitution > 0) {
    return "MuJoCo has no coefficient of restitution";
  }
  if (plan.hasCones()) return "MuJoCo has no cone_limit";
  for (const PeerJoint& joint : plan.joints) {
    if (joint.kind == Kind::kDistance) return "MuJoCo has no joint that keeps a distance";
    if (joint.kind == Kind::kUniversal) return "MuJoCo has no universal joint";
  }
  if (!forest.refusal.empty()) return "MuJoCo's joints make trees, without loops";
  return bodyRefusal(world);
}

std::string mujocoModel(const physics::World& world, const Blueprint& plan, const Forest& forest) {
  return Writer(world, plan, forest).write();
}

}  // namespace app
