// What the second-order steppings reach against exact and 1e-12 references: issue by issue the bars
// that they were built for. All deterministic.
#include <cmath>

#include "tests/scenes/study_runs.h"

namespace scenes {
namespace {

double orderBetween(const std::string& study, const std::string& stepping, int substeps,
                    double duration) {
  const double coarse = runStudy(study, directly(stepping, substeps), duration).errors.error;
  return std::log2(coarse /
                   runStudy(study, directly(stepping, 2 * substeps), duration).errors.error);
}

TEST(Accuracy, OfThePendulumAtAMillisecond) {  // 10 samples a second, 100 substeps each
  const StudyRun symmetric = runStudy("pendulum", directly("symmetric", 100));
  EXPECT_LT(symmetric.errors.error, 1e-4);  // m, measured 6.0e-5
  EXPECT_LT(symmetric.worst.energyDrift, 1e-5);
  const StudyRun bdf2 = runStudy("pendulum", directly("bdf2", 100));
  EXPECT_LT(bdf2.errors.error, 1e-3);  // measured 4.6e-4
}

TEST(Accuracy, OfThePendulumImprovesWithTheSquareOfTheStep) {
  EXPECT_NEAR(orderBetween("pendulum", "symmetric", 50, 10), 2, 0.1);
  EXPECT_NEAR(orderBetween("pendulum", "bdf2", 100, 10), 2, 0.1);
  EXPECT_NEAR(orderBetween("pendulum", "paper", 400, 2), 1, 0.1);
}

TEST(Accuracy, OfThreeLinksAfterASecond) {
  for (const char* stepping : {"bdf2", "symmetric"}) {
    EXPECT_LT(runStudy("three_links", directly(stepping, 50), 1).errors.last, 1e-4) << stepping;
  }
}

TEST(Accuracy, OfADoublePendulumOfBarsOverFiveSeconds) {
  for (const char* stepping : {"bdf2", "symmetric"}) {
    EXPECT_LT(runStudy("double_pendulum", directly(stepping, 100), 5).errors.error, 1e-3)
        << stepping;
  }
}

// A thousand to one, by bdf2 and the direct method: no step is too long, and none gains energy.
TEST(Accuracy, OfTenLinksWithAHeavyEndAtAnyStep) {
  struct Bar {
    int substeps;  // of a twentieth of a second
    double error;  // m
  };
  for (const Bar bar : {Bar{3, 2e-2}, Bar{10, 2e-3}, Bar{50, 4e-4}}) {
    const StudyRun result = runStudy("ten_links_heavy", directly("bdf2", bar.substeps), 1);
    EXPECT_LT(result.errors.error, bar.error) << bar.substeps;
  }
}

TEST(Accuracy, OfAHeavyEndGainsNoEnergyByBdf2) {
  for (const int substeps : {3, 10, 50}) {
    Simulation simulation(studyScene(readStudyCase("ten_links_heavy"), directly("bdf2", substeps)));
    const double start = simulation.metrics().total, scale = 1000 * 9.81;  // m g L of the end
    for (int k = 0; k < 20; ++k) {
      simulation.advance();
      EXPECT_LT(simulation.metrics().total - start, 1e-9 * scale) << substeps;
    }
  }
}

TEST(Accuracy, SymmetricStepsFallBackWhereTheyWouldBlowUp) {
  EXPECT_GT(runStudy("ten_links_heavy", directly("symmetric", 10), 1).fallbacks, 0);  // wh = 3.5
  EXPECT_EQ(runStudy("ten_links_heavy", directly("symmetric", 100), 1).fallbacks, 0);
}

TEST(Accuracy, OfAFreeTopKeepsMomentumAndEnergy) {  // h = 10 ms
  for (const char* stepping : {"paper", "bdf2", "symmetric"}) {
    const StudyRun result = runStudy("top_box", directly(stepping, 5), 5);
    EXPECT_LT(result.worst.angularMomentumDrift, 1e-10) << stepping;
    EXPECT_LT(result.worst.energyDrift, 1e-3) << stepping;
  }
}

TEST(Accuracy, OfALagrangeTopAtAMillisecond) {  // 200 rad/s
  for (const char* stepping : {"bdf2", "symmetric"}) {
    const StudyRun result = runStudy("lagrange_top", directly(stepping, 50), 2);
    EXPECT_LT(result.errors.error, 0.01 * 0.05) << stepping;  // of the circle's radius
  }
}

TEST(Accuracy, OfBallsThatBounceWithoutLossKeepsEveryJoule) {
  for (const char* steps : {"10", "100"}) {  // h = 10 ms and 1 ms
    for (const char* stepping : {"bdf2", "symmetric"}) {
      StudyCase study = readStudyCase("bouncing");
      const std::string fps = std::to_string(study.fps * std::stoi(steps));
      const Scene scene = studyScene(
          study, std::vector<std::string>{"simulation.fps=" + fps, "simulation.substeps=1",
                                          "simulation.method=nonlinear_gauss_seidel",
                                          std::string("simulation.stepping=") + stepping});
      Simulation simulation(scene);
      const double start = simulation.metrics().total;
      double worst = 0;
      for (int k = 0; k < 4 * scene.fps; ++k) {
        simulation.advance();
        worst = std::max(worst, std::abs(simulation.metrics().total / start - 1));
      }
      EXPECT_LT(worst, 1e-12) << stepping << " " << steps;  // bar: 1e-6 and 1e-4
    }
  }
}

}  // namespace
}  // namespace scenes
