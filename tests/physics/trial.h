// A constraint of any kind and its multiplier: what every kind promises is checked by tests that
// are compiled once, not once for each kind.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <vector>

#include "tests/physics/pair.h"

namespace physics::testing {

// c and J, by bodies, of up to three rows; the others are zero.
struct PlainRow {
  int rows = 0;
  bool hasLinear = true;
  Vec3 c = Vec3::Zero();
  std::vector<Mat3> linear, angular;
};

template <class C>
PlainRow plainRowOf(const C& item, const Bodies& bodies) {
  const auto row = rowOf(item, bodies);
  PlainRow plain;
  plain.rows = C::kRows;
  plain.hasLinear = C::kLinear;
  plain.c.template head<C::kRows>() = row.c;
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    plain.linear.emplace_back(Mat3::Zero()).template topRows<C::kRows>() = row.linear[b];
    plain.angular.emplace_back(Mat3::Zero()).template topRows<C::kRows>() = row.angular[b];
  }
  return plain;
}

class Trial {
 public:
  virtual ~Trial() = default;
  virtual bool visit(Bodies& bodies) = 0;
  virtual void iterate(Bodies& bodies, int visits) = 0;  // from no multiplier
  virtual double total() const = 0;                      // of the multiplier, its norm
  virtual double residual(const Bodies& bodies) const = 0;
  virtual void makeScalar() = 0;
  virtual void satisfy(Bodies& bodies) = 0;
  virtual void toGradient(Random& random, Bodies& bodies) const = 0;
  virtual std::unique_ptr<Trial> swapped(const Bodies& bodies) const = 0;
  virtual PlainRow rowAt(const Bodies& bodies) const = 0;
  virtual std::optional<Mat3> stiffness(const Bodies& bodies) const = 0;  // none: it is no force
  // Methods that solve frozen rows see what the kind itself says: c, J, bounds, A, and its bodies.
  virtual void expectFrozen(const Bodies& bodies) const = 0;
};

// A line of the table of kinds.
struct KindOfTrial {
  const char* word;
  int count;  // of bodies
  bool isExternal;
  std::unique_ptr<Trial> (*make)(Random&, Bodies&);
};
inline void PrintTo(const KindOfTrial& kind, std::ostream* to) { *to << kind.word; }
std::vector<KindOfTrial> kindsOfTrials();

class EveryKindTest : public ::testing::TestWithParam<KindOfTrial> {
 protected:
  static Bodies some(Random& random) { return randomBodies(random, GetParam().count); }
  static std::unique_ptr<Trial> trialOf(Random& random, Bodies& bodies) {
    return GetParam().make(random, bodies);
  }
};

inline std::string wordOf(const ::testing::TestParamInfo<KindOfTrial>& info) {
  return info.param.word;
}

// Largest deviation of rows from differences of c, relative to the largest entry.
double deviation(const std::function<PlainRow(const Bodies&)>& rowAt, const Bodies& bodies);

}  // namespace physics::testing
