// A crew whose tasks are numbers of frames, and whose answers are empty.
#include "app/run/draw_apart.h"

#include <algorithm>
#include <string>

#include "app/run/crew.h"

namespace app {

bool drawApart(const std::vector<int>& frames, int workers,
               const std::function<void(int frame)>& draw, const std::function<void()>& done) {
  Crew crew(
      std::min(workers, static_cast<int>(frames.size())),
      [&](const std::string& frame) {
        draw(std::stoi(frame));
        return std::string();
      },
      [&](int, const std::string&) {
        if (done) done();
      });
  for (const int frame : frames) crew.ask(frame, std::to_string(frame));
  if (crew.finish()) return true;
  crew.abandon();
  return false;
}

}  // namespace app
