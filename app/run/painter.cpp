// What a drawing process does: a frame of a motion into its file.
#include "app/run/painter.h"

#include "app/base/stopwatch.h"
#include "app/commands/exit_code.h"
#include "app/run/crew.h"
#include "app/run/open_renderer.h"
#include "app/run/provenance.h"
#include "render/png.h"

namespace app {

namespace {

Json numbers(const physics::Vec3& v) { return {v.x(), v.y(), v.z()}; }

physics::Vec3 vectorFrom(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

}  // namespace

std::string Painter::task(int frame, int last, const scenes::MotionBounds& bounds) {
  return jsonText({{"frame", frame},
                   {"last", last},
                   {"low", numbers(bounds.low)},
                   {"high", numbers(bounds.high)}});
}

std::string Painter::draw(const std::string& task) {
  const Json asked = parseJson(task);
  const int frame = asked.at("frame").get<int>();
  if (!renderer_) renderer_ = openRenderer(job_.renderer);
  Stopwatch watch;
  const scenes::MotionBounds bounds = {vectorFrom(asked.at("low")), vectorFrom(asked.at("high"))};
  std::vector<render::Picture> moments = {view(frame, bounds)};
  for (int at = frame + 1; at <= asked.at("last").get<int>(); ++at) {
    moments.push_back(picture(at, bounds, {}));
  }
  const double view = watch.lap();
  const render::Image& image = drawFrame(*renderer_, frame, moments);
  const double draw = watch.lap();
  render::writePng(image, frames_.file(frame), notesOf(record_, frame));
  return jsonText({{"view", view}, {"draw", draw}, {"write", watch.lap()}});
}

render::Picture Painter::view(int frame, const scenes::MotionBounds& bounds) {
  while (job_.view.hud && static_cast<int>(history_.size()) <= frame) {
    history_.push_back(motion_.moment(static_cast<int>(history_.size())).metrics);
  }
  return picture(frame, bounds, history_);
}

render::Picture Painter::picture(int frame, const scenes::MotionBounds& bounds,
                                 const std::vector<scenes::FrameMetrics>& history) {
  if (!simulation_.show(motion_.moment(frame))) {
    throw CheckFailed("frame " + std::to_string(frame) + " is not finite");
  }
  return scenes::view(simulation_, bounds, job_.view, history);
}

std::optional<render::Renderer::Info> askRendererInfo() {
  std::optional<render::Renderer::Info> info;
  constexpr int kSide = 16;
  Crew crew(
      1,
      [](const std::string&) {
        const auto renderer = openRenderer({kSide, kSide, render::Quality::kDraft, ""});
        const render::Renderer::Info told = renderer->info();
        return jsonText({told.vendor, told.renderer, told.version});
      },
      [&](int, const std::string& answer) {
        const Json told = parseJson(answer);
        info = render::Renderer::Info{told.at(0).get<std::string>(), told.at(1).get<std::string>(),
                                      told.at(2).get<std::string>()};
      });
  crew.ask(0, "info");
  crew.finish();
  return info;
}

}  // namespace app
