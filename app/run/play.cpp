// Steps a scene from frame to frame, and stops where a user or the numbers ask for it.
#include "app/run/play.h"

#include <fmt/format.h>

#include "app/base/interrupt.h"
#include "app/base/stopwatch.h"

namespace app {

namespace {

std::string describe(const scenes::Simulation& simulation,
                     const physics::StepReport::NotFinite& notFinite) {
  std::string text = fmt::format("{}: not finite in the step from frame {}, substep {}",
                                 simulation.scene().name, simulation.frame(), notFinite.substep);
  if (notFinite.body >= 0) text += fmt::format(", body '{}'", simulation.bodyName(notFinite.body));
  text += notFinite.constraint.empty() ? std::string(", in its own motion")
                                       : ", constraint " + notFinite.constraint;
  return text + "; what was written up to this frame is kept";
}

PlayedStep next(scenes::Simulation& simulation, const PlayEngine* engine) {
  PlayedStep step;
  const double processor = processorSeconds();
  const Stopwatch watch;
  if (engine == nullptr) {
    step.report = simulation.advance();
  } else {
    engine->step();
  }
  step.wall = watch.seconds();
  step.processor = processorSeconds() - processor;
  if (engine != nullptr) step.report.notFinite = engine->show();
  return step;
}

}  // namespace

PlayEnd play(scenes::Simulation& simulation, int frames,
             const std::function<bool(const PlayedStep&)>& visit, const PlayEngine* engine,
             int shown) {
  PlayEnd end;
  PlayedStep step;
  bool goesOn = true;
  end.frames = shown;
  if (shown == 0) {
    goesOn = visit(step);
    ++end.frames;
  }
  while (goesOn && end.frames < frames) {
    if (interrupted()) {
      end.code = ExitCode::kInterrupted;
      return end;
    }
    step = next(simulation, engine);
    if (step.report.notFinite) {
      end.code = ExitCode::kCheckFailed;
      end.notFinite = step.report.notFinite;
      end.problem = describe(simulation, *step.report.notFinite);
      return end;
    }
    goesOn = visit(step);
    ++end.frames;
  }
  return end;
}

PlayEnd play(scenes::Simulation& simulation, int frames,
             const std::function<void(double stepSeconds)>& visit, int shown) {
  const auto visitAll = [&](const PlayedStep& step) {
    visit(step.wall);
    return true;
  };
  return play(simulation, frames, visitAll, nullptr, shown);
}

}  // namespace app
