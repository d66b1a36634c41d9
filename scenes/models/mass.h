// Masses of links: of their parts, summed, seen from elsewhere.
#pragma once

#include "scenes/models/model.h"

namespace scenes {

ModelInertial inertialOf(const ModelPart& part);  // in the frame that the part's pose is in
ModelInertial inertialOf(const ModelLink& link);  // stated, else that of its parts
ModelInertial moved(const ModelInertial& inertial, const physics::Pose& pose);
ModelInertial sum(const ModelInertial& a, const ModelInertial& b);

// Where the axes are along which the inertia has no products, and its moments there.
struct PrincipalInertial {
  physics::Pose frame;
  physics::Vec3 moments = physics::Vec3::Zero();  // kg m^2
};
PrincipalInertial principal(const ModelInertial& inertial);

inline physics::Pose operator*(const physics::Pose& outer, const physics::Pose& inner) {
  return {outer.x + outer.q * inner.x, (outer.q * inner.q).normalized()};
}

}  // namespace scenes
