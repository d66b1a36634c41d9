// Runs of the accuracy study's cases, for tests of what a method reaches.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenes/study/study_case.h"
#include "scenes/study/study_files.h"
#include "scenes/study/study_trace.h"

namespace scenes {

struct StudyRun {
  StudyErrors errors;
  StudyWorst worst;
  int restarts = 0, fallbacks = 0;
};

// The case with these overrides, over its duration or a shorter one [s].
inline StudyRun runStudy(const std::string& name, std::vector<std::string> set,
                         double duration = 0) {
  StudyCase study = readStudyCase(name);
  if (duration > 0) {
    study.duration = duration;
    set.push_back("duration=" + std::to_string(duration));
  }
  Simulation simulation(studyScene(study, set));
  StudyTracer tracer(study, simulation);
  StudyRun result;
  tracer.observe(simulation);
  for (int k = 1; k < study.sampleCount() && simulation.isFinite(); ++k) {
    const physics::StepReport report = simulation.advance();
    result.restarts += report.restarts;
    result.fallbacks += report.fallbacks;
    tracer.observe(simulation);
  }
  EXPECT_TRUE(simulation.isFinite());
  result.errors = compare(study, tracer.trace(), truthOf(study, nullptr));
  result.worst = tracer.worst();
  return result;
}

// Overrides for a stepping with the direct method, `substeps` to a sample.
inline std::vector<std::string> directly(const std::string& stepping, int substeps) {
  return {"simulation.method=direct", "simulation.stepping=" + stepping,
          "simulation.substeps=" + std::to_string(substeps)};
}

}  // namespace scenes
