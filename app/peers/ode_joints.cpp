// Whole joints in ODE.
#include "app/peers/ode_joints.h"

namespace app {
namespace {

using physics::Vec3;

void addBall(dWorldID world, dBodyID first, dBodyID second, const Vec3& p) {
  const dJointID ball = dJointCreateBall(world, nullptr);
  dJointAttach(ball, first, second);
  dJointSetBallAnchor(ball, p.x(), p.y(), p.z());
}

void addHinge(dWorldID world, dBodyID first, dBodyID second, const Vec3& p, const Vec3& n,
              const std::optional<std::array<double, 2>>& limits) {
  const dJointID hinge = dJointCreateHinge(world, nullptr);
  dJointAttach(hinge, first, second);
  dJointSetHingeAnchor(hinge, p.x(), p.y(), p.z());
  dJointSetHingeAxis(hinge, n.x(), n.y(), n.z());
  if (!limits) return;
  dJointSetHingeParam(hinge, dParamLoStop, (*limits)[0]);
  dJointSetHingeParam(hinge, dParamHiStop, (*limits)[1]);
}

void addUniversal(dWorldID world, dBodyID first, dBodyID second, const Vec3& p, const Vec3& n1,
                  const Vec3& n2) {
  const dJointID universal = dJointCreateUniversal(world, nullptr);
  dJointAttach(universal, first, second);
  dJointSetUniversalAnchor(universal, p.x(), p.y(), p.z());
  dJointSetUniversalAxis1(universal, n1.x(), n1.y(), n1.z());
  dJointSetUniversalAxis2(universal, n2.x(), n2.y(), n2.z());
}

void addSlider(dWorldID world, dBodyID first, dBodyID second, const Vec3& n) {
  const dJointID slider = dJointCreateSlider(world, nullptr);
  dJointAttach(slider, first, second);
  dJointSetSliderAxis(slider, n.x(), n.y(), n.z());
}

// `first` is not static.
void addDistance(dWorldID world, dBodyID first, dBodyID second, const Vec3& p1, const Vec3& p2,
                 double length) {
  const dJointID distance = dJointCreateDBall(world, nullptr);
  dJointAttach(distance, first, second);
  dJointSetDBallAnchor1(distance, p1.x(), p1.y(), p1.z());
  dJointSetDBallAnchor2(distance, p2.x(), p2.y(), p2.z());
  dJointSetDBallDistance(distance, length);
}

}  // namespace

// The second body first: the angle of ODE's hinge is that of its first body against its second.
void addOdeJoint(dWorldID world, dBodyID a, dBodyID b, const Blueprint& plan,
                 const PeerJoint& joint) {
  if (a == nullptr && b == nullptr) return;
  const Vec3 pa = anchorAtStart(plan, joint, 0), pb = anchorAtStart(plan, joint, 1);
  const Vec3 na = axisAtStart(plan, joint, 0), nb = axisAtStart(plan, joint, 1);
  switch (joint.kind) {
    case PeerJoint::Kind::kBall:
      return addBall(world, b, a, pb);
    case PeerJoint::Kind::kHinge:
      return addHinge(world, b, a, pb, na, joint.limits);
    case PeerJoint::Kind::kUniversal:
      return addUniversal(world, b, a, pb, nb, na);
    case PeerJoint::Kind::kSlider:
      return addSlider(world, b, a, na);
    case PeerJoint::Kind::kDistance:
      return b != nullptr ? addDistance(world, b, a, pb, pa, joint.length)
                          : addDistance(world, a, b, pa, pb, joint.length);
  }
}

}  // namespace app
