// The order of the steppings by self-convergence, on every kind of constraint and force.
#include <gtest/gtest.h>

#include "tests/physics/order_cases.h"

namespace physics::testing {
namespace {

constexpr int kSteps = 100;  // of 4 ms, and halved twice: there the leading term of the error rules

class Order : public ::testing::TestWithParam<OrderCase> {};

TEST_P(Order, OfBdf2IsTwo) {
  EXPECT_NEAR(selfConvergence(GetParam(), Stepping::kBdf2, Method::kNonlinearGaussSeidel, kSteps),
              2, 0.15);
}

TEST_P(Order, OfTheSymmetricSchemeIsTwo) {
  EXPECT_NEAR(
      selfConvergence(GetParam(), Stepping::kSymmetric, Method::kNonlinearGaussSeidel, kSteps), 2,
      0.15);
}

TEST_P(Order, IsTheSameWithTheDirectMethod) {
  for (const Stepping stepping : {Stepping::kBdf2, Stepping::kSymmetric}) {
    EXPECT_NEAR(selfConvergence(GetParam(), stepping, Method::kDirect, kSteps), 2, 0.15);
  }
}

TEST_P(Order, OfThePapersSchemeIsOne) {
  if (GetParam().name == "FreeTop") GTEST_SKIP() << "free motion keeps energy and momentum: two";
  EXPECT_NEAR(selfConvergence(GetParam(), Stepping::kPaper, Method::kNonlinearGaussSeidel, kSteps),
              1, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Order, ::testing::ValuesIn(orderCases()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace physics::testing
