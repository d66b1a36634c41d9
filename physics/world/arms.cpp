// Arms of a World.
#include "physics/kinematics/driven_arm.h"
#include "physics/world/impl.h"

namespace physics {

int World::add(const ArmDef& def) {
  DrivenArm driven = makeDriven(def);
  for (int k = 0; k < driven.arm.size(); ++k) {
    driven.bodies.push_back(add(linkBody(def, driven, k)));
  }
  impl_->arms.push_back(std::move(driven));
  return static_cast<int>(impl_->arms.size()) - 1;
}

void World::setArmTarget(int arm, const Vec3& target) {
  require(arm >= 0 && arm < static_cast<int>(impl_->arms.size()), "no such arm");
  require(target.allFinite(), "an arm's target must be finite");
  impl_->arms[arm].target = target;
}

std::vector<ArmReport> World::arms() const {
  std::vector<ArmReport> reports;
  for (const DrivenArm& driven : impl_->arms) reports.push_back(report(driven));
  return reports;
}

}  // namespace physics
