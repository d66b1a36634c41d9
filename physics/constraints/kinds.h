// The table of kinds, in the order they are swept. A new constraint is its file and its line here.
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>

#include "physics/constraints/axle.h"
#include "physics/constraints/ball_socket.h"
#include "physics/constraints/bend.h"
#include "physics/constraints/cone_limit.h"
#include "physics/constraints/distance.h"
#include "physics/constraints/drag.h"
#include "physics/constraints/drive.h"
#include "physics/constraints/force.h"
#include "physics/constraints/hardening_spring.h"
#include "physics/constraints/link.h"
#include "physics/constraints/motor.h"
#include "physics/constraints/motor_torque.h"
#include "physics/constraints/orientation_lock.h"
#include "physics/constraints/panel_drag.h"
#include "physics/constraints/perpendicular.h"
#include "physics/constraints/point_gravity.h"
#include "physics/constraints/point_on_line.h"
#include "physics/constraints/rope_length.h"
#include "physics/constraints/slide_limit.h"
#include "physics/constraints/spring.h"
#include "physics/constraints/twist_limit.h"
#include "physics/constraints/volume.h"

namespace physics {

template <class D, class C>
constexpr const char* wordOf() {
  if constexpr (requires { C::kWord; }) return C::kWord;
  return D::kWord;
}

template <class D, class C>
struct Kind {
  using Def = D;
  using Item = C;
  static constexpr const char* kWord = wordOf<D, C>();  // the definition's, or the item's own
  Set<C> set;
};

using Kinds = std::tuple<                       //
    Kind<SpringDef, Spring>,                    //
    Kind<SpringDef, VectorSpring>,              //
    Kind<HardeningSpringDef, HardeningSpring>,  //
    Kind<PointGravityDef, PointGravity>,        //
    Kind<ForceDef, ConstantForce>,              //
    Kind<DragDef, Drag>,                        //
    Kind<PanelDragDef, PanelDrag>,              //
    Kind<BendDef, Bend>,                        //
    Kind<DriveDef, Drive>,                      //
    Kind<MotorTorqueDef, MotorTorque>,          //
    Kind<MotorDef, Motor>,                      //
    Kind<VolumeDef, Volume>,                    //
    Kind<RopeLengthDef, RopeLength>,            //
    Kind<LinkDef, Link>,                        //
    Kind<DistanceDef, Distance>,                //
    Kind<ConeLimitDef, ConeLimit>,              //
    Kind<TwistLimitDef, TwistLimit>,            //
    Kind<SlideLimitDef, SlideLimit>,            //
    Kind<AxleDef, Axle>,                        //
    Kind<PerpendicularDef, Perpendicular>,      //
    Kind<OrientationLockDef, OrientationLock>,  //
    Kind<PointOnLineDef, PointOnLine>,          //
    Kind<BallSocketDef, BallSocket>>;           //

// Calls f with each of them. By index: std::apply asks of each f if it throws, a tenth of a file's
// time to compile.
template <class K, class F, std::size_t... kIndex>
void forEachKind(K& kinds, F& f, std::index_sequence<kIndex...>) {
  (f(std::get<kIndex>(kinds)), ...);
}
template <class F>
void forEachKind(Kinds& kinds, F&& f) {
  forEachKind(kinds, f, std::make_index_sequence<std::tuple_size_v<Kinds>>());
}
template <class F>
void forEachKind(const Kinds& kinds, F&& f) {
  forEachKind(kinds, f, std::make_index_sequence<std::tuple_size_v<Kinds>>());
}

}  // namespace physics
