// The cases of the kinds that prismatic and universal joints are made of, and of a constant force.
#pragma once

#include "physics/constraints/kinds.h"
#include "physics/make/matter.h"

namespace physics::testing {

template <class Item>
struct Case;

template <>
struct Case<ConstantForce> {
  static constexpr bool kExternal = true;
  static constexpr int kCount = 1;
  static ConstantForce make(Random& random, Bodies& bodies);
  static void toGradient(const ConstantForce&, Random&, Bodies&) {}
  static void satisfy(ConstantForce& item, Bodies& bodies);
  static ConstantForce swapped(ConstantForce item, const Bodies& bodies);
};

template <>
struct Case<SlideLimit> {
  static SlideLimit make(Random& random, Bodies& bodies);
  static void toGradient(const SlideLimit&, Random&, Bodies&) {}
  static void satisfy(SlideLimit& item, Bodies& bodies);
  static SlideLimit swapped(SlideLimit item, const Bodies& bodies);
};

template <>
struct Case<PointOnLine> {
  static PointOnLine make(Random& random, Bodies& bodies);
  static void toGradient(const PointOnLine&, Random&, Bodies&) {}
  static void satisfy(PointOnLine& item, Bodies& bodies);
  static PointOnLine swapped(PointOnLine item, const Bodies& bodies);
};

template <>
struct Case<OrientationLock> {
  static OrientationLock make(Random& random, Bodies& bodies);
  static void toGradient(const OrientationLock&, Random&, Bodies&) {}
  static void satisfy(OrientationLock& item, Bodies& bodies);
  static OrientationLock swapped(OrientationLock item, const Bodies& bodies);
};

template <>
struct Case<Perpendicular> {
  static Perpendicular make(Random& random, Bodies& bodies);
  static void toGradient(const Perpendicular&, Random&, Bodies&) {}
  static void satisfy(Perpendicular& item, Bodies& bodies);
  static Perpendicular swapped(Perpendicular item, const Bodies& bodies);
};

}  // namespace physics::testing
