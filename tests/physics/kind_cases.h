// What the checks that every kind runs need to know of a kind. The primary template stays
// undefined: a kind in physics/kinds.h without a Case does not compile.
//   make        some constraint of the kind between bodies 0 and 1, violated where they stand
//   toGradient  moves the bodies to where its rows are the gradient of its c; where that is
//               everywhere, nothing happens
//   satisfy     changes it (or the poses at the start of the substep) so that it has nothing to do
//   swapped     the same constraint with its two bodies named the other way round
#pragma once

#include <gtest/gtest.h>

#include "physics/kinds.h"
#include "tests/physics/pair.h"

namespace physics::testing {

template <class Item>
struct Case;

template <>
struct Case<Spring> {
  static Spring make(Random& random, Bodies& bodies);
  static void toGradient(const Spring&, Random&, Bodies&) {}
  static void satisfy(Spring& item, Bodies& bodies);
  static Spring swapped(Spring item, const Bodies&);
};

template <>
struct Case<Drive> {
  static Drive make(Random& random, Bodies& bodies);
  static void toGradient(const Drive& item, Random&, Bodies& bodies);
  static void satisfy(Drive& item, Bodies& bodies);
  static Drive swapped(Drive item, const Bodies&);
};

template <>
struct Case<Motor> {
  static Motor make(Random& random, Bodies& bodies);
  static void toGradient(const Motor& item, Random& random, Bodies& bodies);
  static void satisfy(Motor& item, Bodies& bodies);
  static Motor swapped(Motor item, const Bodies& bodies);
};

template <>
struct Case<Distance> {
  static Distance make(Random& random, Bodies& bodies);
  static void toGradient(const Distance&, Random&, Bodies&) {}
  static void satisfy(Distance& item, Bodies& bodies);
  static Distance swapped(Distance item, const Bodies&);
};

template <>
struct Case<ConeLimit> {
  static ConeLimit make(Random& random, Bodies& bodies);
  static void toGradient(const ConeLimit&, Random&, Bodies&) {}
  static void satisfy(ConeLimit& item, Bodies& bodies);
  static ConeLimit swapped(ConeLimit item, const Bodies&);
};

template <>
struct Case<TwistLimit> {
  static TwistLimit make(Random& random, Bodies& bodies);
  static void toGradient(const TwistLimit&, Random&, Bodies&) {}
  static void satisfy(TwistLimit& item, Bodies& bodies);
  static TwistLimit swapped(TwistLimit item, const Bodies&);
};

template <>
struct Case<Axle> {
  static Axle make(Random& random, Bodies& bodies);
  static void toGradient(const Axle&, Random&, Bodies&) {}
  static void satisfy(Axle& item, Bodies& bodies);
  static Axle swapped(Axle item, const Bodies&);
};

template <>
struct Case<BallSocket> {
  static BallSocket make(Random& random, Bodies& bodies);
  static void toGradient(const BallSocket&, Random&, Bodies&) {}
  static void satisfy(BallSocket& item, Bodies& bodies);
  static BallSocket swapped(BallSocket item, const Bodies&);
};

// Every entry of the table of kinds, as GoogleTest wants it.
template <class Tuple>
struct ListOf;
template <class... K>
struct ListOf<std::tuple<K...>> {
  using Types = ::testing::Types<K...>;
};
struct KindName {
  template <class K>
  static std::string GetName(int) {
    return K::kWord;
  }
};

}  // namespace physics::testing
