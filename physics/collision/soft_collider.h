// Points and links of ropes, cloths and soft bodies against the shapes of rigid bodies. They do not
// touch each other. A link is a capsule between two points, so that an edge does not pass between
// them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/bodies/body.h"
#include "physics/bodies/compound.h"
#include "physics/collision/collider.h"
#include "physics/collision/solid.h"

namespace physics {

struct SoftElement {
  BodyId from = 0, to = 0;  // the same for a point
  double radius = 0;        // m
  Friction friction;
  bool isPoint() const { return from == to; }
};

// Where an element and a body come near each other: a plane of the body, and a place on the
// element.
struct SoftTouch {
  int element = 0;
  BodyId body = 0;
  double along = 0;             // 0 at `from`, 1 at `to`
  Vec3 onBody = Vec3::Zero();   // body frame, on the surface
  Vec3 normal = Vec3::UnitY();  // body frame, unit, towards the element
  double gap = 0;               // m
};

// Those that may touch within a step.
struct SoftPair {
  int element = 0;
  BodyId body = 0;
};

class SoftCollider {
 public:
  void addBody(BodyId body, const Shape& shape);
  void addElement(const SoftElement& element) { elements_.push_back(element); }
  // Links that end at this point never touch this body, nor does the point: it hangs on it.
  void ignore(BodyId point, BodyId body);
  bool empty() const { return elements_.empty() || rigids_.empty(); }
  std::size_t bytes() const;
  std::size_t elementCount() const { return elements_.size(); }
  const SoftElement& element(int index) const { return elements_[index]; }

  // Every place whose gap at `start` is at most `margin` [m] plus the way that element and body
  // make towards each other until `end`; taken at `start`, so that nothing passes through a thin
  // body. Ordered by element and body, valid until the next call; allocates only while it grows.
  // `leftOut`, where not empty, by body: an element and a body that both are, or are static, are
  // not looked at.
  std::span<const SoftTouch> find(std::span<const Pose> start, std::span<const Pose> end,
                                  double margin, std::span<const char> leftOut = {});
  // The same for these pairs alone.
  std::span<const SoftTouch> find(std::span<const SoftPair> pairs, std::span<const Pose> start,
                                  std::span<const Pose> end, double margin);

 private:
  struct Rigid {
    BodyId body = 0;
    bool isPart = false;
    Pose inBody;
    collision::Solid solid;

    Pose at(const Pose& ofBody) const { return isPart ? placed(ofBody, inBody) : ofBody; }
    Mat3 rotation = Mat3::Identity();  // at the start
    collision::Bounds path;            // from start to end
    Vec3 move = Vec3::Zero();
    double turn = 0;  // the furthest that turning moves a point of it [m]
  };
  void takeMotion(std::span<const Pose> start, std::span<const Pose> end, double margin);
  void addRigid(BodyId body, const Shape& shape);
  bool isIgnored(const SoftElement& element, BodyId body) const;
  bool mayTouch(const SoftElement& element, const Rigid& rigid, std::span<const Pose> start,
                std::span<const Pose> end, double margin) const;
  void look(int element, const Rigid& rigid, std::span<const Pose> start, std::span<const Pose> end,
            double margin);

  // `swap`: the manifold has the rigid body first.
  void take(int element, const collision::Solid& solid, const Rigid& rigid,
            const collision::Relative& pose, const Manifold& manifold, bool swap);

  std::vector<SoftElement> elements_;
  std::vector<Rigid> rigids_;
  std::vector<int> rigidOf_;                    // by body, the first of its parts; -1: none
  std::vector<std::array<BodyId, 2>> ignored_;  // sorted
  std::vector<SoftTouch> touches_;
};

}  // namespace physics
