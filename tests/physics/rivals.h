// The rival methods as parameters of tests.
#pragma once

#include <gtest/gtest.h>

#include "physics/world.h"

namespace physics::testing {

struct Rival {
  const char* name;
  Method method;
};

inline constexpr Rival kRivals[] = {{"Xpbd", Method::kXpbd},
                                    {"SequentialImpulses", Method::kSequentialImpulses},
                                    {"Penalty", Method::kPenalty},
                                    {"PenaltyExplicit", Method::kPenaltyExplicit}};

inline void PrintTo(const Rival& rival, std::ostream* out) { *out << rival.name; }

class Rivals : public ::testing::TestWithParam<Rival> {
 protected:
  Settings settings(int stepsPerSecond, int substeps = 1) const {
    Settings s;
    s.method = GetParam().method;
    s.dt = 1.0 / stepsPerSecond;
    s.substeps = substeps;
    s.iterations = 1;
    return s;
  }
  static constexpr double kGravity = 9.81;
};

inline std::string nameOf(const ::testing::TestParamInfo<Rival>& info) { return info.param.name; }

}  // namespace physics::testing
