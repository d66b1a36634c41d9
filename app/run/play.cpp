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

}  // namespace

PlayEnd play(scenes::Simulation& simulation, int frames,
             const std::function<void(double stepSeconds)>& visit) {
  PlayEnd end;
  double seconds = 0;
  while (true) {
    visit(seconds);
    if (++end.frames >= frames) return end;
    if (interrupted()) {
      end.code = ExitCode::kInterrupted;
      return end;
    }
    const Stopwatch watch;
    const physics::StepReport report = simulation.advance();
    seconds = watch.seconds();
    if (report.notFinite) {
      end.code = ExitCode::kCheckFailed;
      end.problem = describe(simulation, *report.notFinite);
      return end;
    }
  }
}

}  // namespace app
