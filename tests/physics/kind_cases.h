// What the checks that every kind runs need to know of a kind. The primary template stays
// undefined: a kind in physics/constraints/kinds.h without a Case does not compile.
//   make        some constraint of the kind between bodies 0 and 1, violated where they stand
//   toGradient  moves the bodies to where its rows are the gradient of its c; where that is
//               everywhere, nothing happens
//   satisfy     changes it (or the poses at the start of the substep) so that it has nothing to do
//   swapped     the same constraint with its bodies named in the reverse order
//   kCount      how many bodies it takes, where that is not two
//   kExternal   it is a force of the surroundings, which owes nobody momentum
#pragma once

#include <gtest/gtest.h>

#include "physics/constraints/kinds.h"
#include "tests/physics/pair.h"
#include "tests/physics/slide_cases.h"

namespace physics::testing {

template <class Item>
struct Case;

template <class Item>
constexpr int countOf() {
  if constexpr (requires { Case<Item>::kCount; }) return Case<Item>::kCount;
  return 2;
}
template <class Item>
constexpr bool isExternal() {
  return requires { Case<Item>::kExternal; };
}

template <>
struct Case<Spring> {
  static Spring make(Random& random, Bodies& bodies);
  static void toGradient(const Spring&, Random&, Bodies&) {}
  static void satisfy(Spring& item, Bodies& bodies);
  static Spring swapped(Spring item, const Bodies& bodies);
};

template <>
struct Case<VectorSpring> {
  static VectorSpring make(Random& random, Bodies& bodies);
  static void toGradient(const VectorSpring&, Random&, Bodies&) {}
  static void satisfy(VectorSpring& item, Bodies& bodies);
  static VectorSpring swapped(VectorSpring item, const Bodies& bodies);
};

template <>
struct Case<HardeningSpring> {
  static HardeningSpring make(Random& random, Bodies& bodies);
  static void toGradient(const HardeningSpring&, Random&, Bodies&) {}
  static void satisfy(HardeningSpring& item, Bodies& bodies);
  static HardeningSpring swapped(HardeningSpring item, const Bodies& bodies);
};

template <>
struct Case<PointGravity> {
  static PointGravity make(Random& random, Bodies& bodies);
  static void toGradient(const PointGravity&, Random&, Bodies&) {}
  static void satisfy(PointGravity& item, Bodies& bodies);
  static PointGravity swapped(PointGravity item, const Bodies& bodies);
};

template <>
struct Case<Drag> {
  static constexpr bool kExternal = true;
  static constexpr int kCount = 1;
  static Drag make(Random& random, Bodies& bodies);
  static void toGradient(const Drag&, Random&, Bodies&) {}
  static void satisfy(Drag& item, Bodies& bodies);
  static Drag swapped(Drag item, const Bodies& bodies);
};

template <>
struct Case<PanelDrag> {
  static constexpr bool kExternal = true;
  static constexpr int kCount = 3;
  static PanelDrag make(Random& random, Bodies& bodies);
  static void toGradient(const PanelDrag&, Random&, Bodies&) {}
  static void satisfy(PanelDrag& item, Bodies& bodies);
  static PanelDrag swapped(PanelDrag item, const Bodies& bodies);
};

template <>
struct Case<Bend> {
  static constexpr int kCount = 3;
  static Bend make(Random& random, Bodies& bodies);
  static void toGradient(const Bend&, Random&, Bodies&) {}
  static void satisfy(Bend& item, Bodies& bodies);
  static Bend swapped(Bend item, const Bodies& bodies);
};

template <>
struct Case<Drive> {
  static Drive make(Random& random, Bodies& bodies);
  static void toGradient(const Drive& item, Random& random, Bodies& bodies);
  static void satisfy(Drive& item, Bodies& bodies);
  static Drive swapped(Drive item, const Bodies& bodies);
};

template <>
struct Case<MotorTorque> {
  static MotorTorque make(Random& random, Bodies& bodies);
  static void toGradient(const MotorTorque& item, Random& random, Bodies& bodies);
  static void satisfy(MotorTorque& item, Bodies& bodies);
  static MotorTorque swapped(MotorTorque item, const Bodies& bodies);
};

template <>
struct Case<Motor> {
  static Motor make(Random& random, Bodies& bodies);
  static void toGradient(const Motor& item, Random& random, Bodies& bodies);
  static void satisfy(Motor& item, Bodies& bodies);
  static Motor swapped(Motor item, const Bodies& bodies);
};

template <>
struct Case<Volume> {
  static constexpr int kCount = 4;
  static Volume make(Random& random, Bodies& bodies);
  static void toGradient(const Volume&, Random&, Bodies&) {}
  static void satisfy(Volume& item, Bodies& bodies);
  static Volume swapped(Volume item, const Bodies& bodies);
};

template <>
struct Case<RopeLength> {
  static constexpr int kCount = 5;
  static RopeLength make(Random& random, Bodies& bodies);
  static void toGradient(const RopeLength&, Random&, Bodies&) {}
  static void satisfy(RopeLength& item, Bodies& bodies);
  static RopeLength swapped(RopeLength item, const Bodies& bodies);
};

template <>
struct Case<Link> {
  static Link make(Random& random, Bodies& bodies);
  static void toGradient(const Link&, Random&, Bodies&) {}
  static void satisfy(Link& item, Bodies& bodies);
  static Link swapped(Link item, const Bodies& bodies);
};

template <>
struct Case<Distance> {
  static Distance make(Random& random, Bodies& bodies);
  static void toGradient(const Distance&, Random&, Bodies&) {}
  static void satisfy(Distance& item, Bodies& bodies);
  static Distance swapped(Distance item, const Bodies& bodies);
};

template <>
struct Case<ConeLimit> {
  static ConeLimit make(Random& random, Bodies& bodies);
  static void toGradient(const ConeLimit&, Random&, Bodies&) {}
  static void satisfy(ConeLimit& item, Bodies& bodies);
  static ConeLimit swapped(ConeLimit item, const Bodies& bodies);
};

template <>
struct Case<TwistLimit> {
  static TwistLimit make(Random& random, Bodies& bodies);
  static void toGradient(const TwistLimit&, Random&, Bodies&) {}
  static void satisfy(TwistLimit& item, Bodies& bodies);
  static TwistLimit swapped(TwistLimit item, const Bodies& bodies);
};

template <>
struct Case<Axle> {
  static Axle make(Random& random, Bodies& bodies);
  static void toGradient(const Axle&, Random&, Bodies&) {}
  static void satisfy(Axle& item, Bodies& bodies);
  static Axle swapped(Axle item, const Bodies& bodies);
};

template <>
struct Case<BallSocket> {
  static BallSocket make(Random& random, Bodies& bodies);
  static void toGradient(const BallSocket&, Random&, Bodies&) {}
  static void satisfy(BallSocket& item, Bodies& bodies);
  static BallSocket swapped(BallSocket item, const Bodies& bodies);
};

}  // namespace physics::testing
