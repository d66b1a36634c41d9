// The table of kinds, in the order they are swept. A new constraint is its file and its line here.
#pragma once

#include <tuple>

#include "physics/constraints/axle.h"
#include "physics/constraints/ball_socket.h"
#include "physics/constraints/cone_limit.h"
#include "physics/constraints/distance.h"
#include "physics/constraints/drive.h"
#include "physics/constraints/motor.h"
#include "physics/constraints/spring.h"
#include "physics/constraints/twist_limit.h"

namespace physics {

template <class D, class C>
struct Kind {
  using Def = D;
  using Item = C;
  static constexpr const char* kWord = D::kWord;
  Set<C> set;
};

using Kinds = std::tuple<              //
    Kind<SpringDef, Spring>,           //
    Kind<DriveDef, Drive>,             //
    Kind<MotorDef, Motor>,             //
    Kind<DistanceDef, Distance>,       //
    Kind<ConeLimitDef, ConeLimit>,     //
    Kind<TwistLimitDef, TwistLimit>,   //
    Kind<AxleDef, Axle>,               //
    Kind<BallSocketDef, BallSocket>>;  //

template <class F>
void forEachKind(Kinds& kinds, F&& f) {
  std::apply([&](auto&... kind) { (f(kind), ...); }, kinds);
}
template <class F>
void forEachKind(const Kinds& kinds, F&& f) {
  std::apply([&](const auto&... kind) { (f(kind), ...); }, kinds);
}

}  // namespace physics
