// Draws two placed simulations with one camera, and puts their pictures on a page.
#include "app/trust/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/base/interrupt.h"
#include "app/run/draw_apart.h"
#include "app/run/open_renderer.h"
#include "render/film.h"
#include "render/page.h"
#include "render/png.h"
#include "scenes/view/view.h"

namespace app {

namespace {

const render::Color kInk{0.13f, 0.14f, 0.16f, 1}, kMark{0.84f, 0.10f, 0.12f, 1};
const render::Color kTrusted{0.20f, 0.63f, 0.38f, 1}, kBeyond{0.93f, 0.80f, 0.78f, 1};
constexpr int kSides = 2;

// Where things are on the page; pixels at 720 lines, scaled.
struct SideLayout {
  explicit SideLayout(const render::RendererOptions& options)
      : width(options.width), height(options.height), scale(static_cast<float>(height) / 720) {
    const int rule = px(2);
    top = px(34);
    paneWidth = std::max(1, (width - rule) / kSides);
    paneHeight = std::max(1, height - top - px(58));
    barTop = height - px(46);
    barLeft = px(16);
    barRight = std::max(barLeft + 1, width - px(16));
    barBottom = barTop + px(10);
  }
  int px(float pixels) const { return std::max(1, static_cast<int>(std::lround(scale * pixels))); }
  int leftOf(int side) const { return side == 0 ? 0 : width - paneWidth; }
  int barAt(double share) const {
    return barLeft +
           static_cast<int>(std::lround((barRight - barLeft) * std::clamp(share, 0., 1.)));
  }

  int width, height;
  float scale;
  int top = 0, paneWidth = 0, paneHeight = 0;
  int barTop = 0, barBottom = 0, barLeft = 0, barRight = 0;
};

render::Page::Tile filled(int left, int top, int right, int bottom, const render::Color& color) {
  render::Page::Tile tile{left, top, {std::max(0, right - left), std::max(0, bottom - top), {}}};
  for (int i = 0; i < tile.image.width * tile.image.height; ++i) {
    for (int k = 0; k < 3; ++k) {
      tile.image.rgb.push_back(static_cast<std::uint8_t>(std::lround(255 * color[k])));
    }
  }
  return tile;
}

// A simulation that goes from frame to frame of a track.
class Placed {
 public:
  Placed(const scenes::Scene& scene, const Track& track) : simulation_(scene), track_(track) {}

  const scenes::Simulation& at(int frame) {
    while (simulation_.frame() < frame) {
      const TrackFrame& next = track_.frames.at(simulation_.frame() + 1);
      if (!simulation_.place(next.poses, next.velocities)) {
        throw CheckFailed(fmt::format("frame {}: a state that is not finite cannot be drawn",
                                      simulation_.frame() + 1));
      }
    }
    return simulation_;
  }

 private:
  scenes::Simulation simulation_;
  const Track& track_;
};

scenes::MotionBounds boundsOf(const SideBySide& sides, int frames) {
  scenes::MotionBounds bounds;
  if (!scenes::needsMotionBounds(sides.scene)) return bounds;
  for (const Track* track : {sides.left, sides.right}) {
    Placed placed(sides.scene, *track);
    for (int f = 0; f < frames && !interrupted(); ++f) bounds.include(placed.at(f));
  }
  return bounds;
}

void markBody(const scenes::Simulation& simulation, physics::BodyId body,
              render::Picture& picture) {
  const render::Vec3f at = simulation.world().bodies().pose[body].x.cast<float>();
  picture.dots.push_back({at, kMark, 12});
  picture.labels.push_back({at, simulation.bodyName(body), {10, -10}, kMark, 22});
}

// What a drawing process has: both sides at a frame, on one page, into its file.
class SidePainter {
 public:
  SidePainter(const SideBySide& sides, const render::RendererOptions& whole)
      : sides_(sides), layout_(whole), pane_(whole) {
    pane_.width = layout_.paneWidth;
    pane_.height = layout_.paneHeight;
    bounds_ = boundsOf(sides, std::min(sides.left->frameCount(), sides.right->frameCount()));
  }

  // Frames in ascending order.
  void draw(int frame, const std::filesystem::path& file) {
    if (!renderer_) open();
    render::Page page = blank(frame);
    for (int side = 0; side < kSides; ++side) {
      page.tiles.push_back({layout_.leftOf(side), layout_.top, image(side, frame)});
    }
    render::writePng(printer_->print(page), file);
  }

 private:
  void open() {
    renderer_ = openRenderer(pane_);
    printer_ = std::make_unique<render::PagePrinter>();
    for (const Track* track : {sides_.left, sides_.right}) {
      placed_.push_back(std::make_unique<Placed>(sides_.scene, *track));
    }
  }

  const render::Image& image(int side, int frame) {
    scenes::ViewOptions view;
    view.overlays = sides_.scene.overlays;
    view.aspect = static_cast<double>(pane_.width) / pane_.height;
    const scenes::Simulation& simulation = placed_[side]->at(frame);
    render::Picture picture = scenes::view(simulation, bounds_, view, {});
    if (isApart(frame) && sides_.body > 0) markBody(simulation, sides_.body, picture);
    return drawFrame(*renderer_, frame, {&picture, 1});
  }

  bool isApart(int frame) const { return sides_.marked >= 0 && frame >= sides_.marked; }

  render::Page blank(int frame) const {
    render::Page page;
    page.width = layout_.width;
    page.height = layout_.height;
    addText(page, 14, 24, 20, 0, sides_.leftLabel, kInk);
    const float right = static_cast<float>(layout_.leftOf(1)) / layout_.scale;
    addText(page, right + 14, 24, 20, 0, sides_.rightLabel, kInk);
    addBar(sides_.left->frames.at(frame).time, page);
    const float middle = 0.5f * static_cast<float>(layout_.width) / layout_.scale;
    if (isApart(frame)) addText(page, middle, 710, 18, 0.5f, sides_.parting, kMark);
    return page;
  }

  void addText(render::Page& page, float x, float y, float size, float anchor,
               const std::string& words, const render::Color& color) const {
    const float s = layout_.scale;
    page.texts.push_back({{s * x, s * y}, words, s * size, anchor, color, false});
  }

  // Trusted, beyond, and where the film is.
  void addBar(double time, render::Page& page) const {
    const SideLayout& l = layout_;
    const double end = sides_.end > 0 ? sides_.end : 1;
    const int until = l.barAt(sides_.until / end), now = l.barAt(time / end);
    page.tiles.push_back(filled(l.barLeft, l.barTop, until, l.barBottom, kTrusted));
    page.tiles.push_back(filled(until, l.barTop, l.barRight, l.barBottom, kBeyond));
    page.tiles.push_back(
        filled(now - l.px(2), l.barTop - l.px(4), now + l.px(2), l.barBottom + l.px(4), kInk));
    addText(page, 16, 710, 18, 0, fmt::format("t = {:.2f} s", time), kInk);
    const float right = static_cast<float>(l.barRight) / l.scale;
    addText(page, right, 710, 18, 1, sides_.endText, kInk);
  }

  const SideBySide& sides_;
  const SideLayout layout_;
  render::RendererOptions pane_;
  scenes::MotionBounds bounds_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::PagePrinter> printer_;
  std::vector<std::unique_ptr<Placed>> placed_;  // by side
};

}  // namespace

bool drawSideBySide(const SideBySide& sides, const SideDrawing& drawing,
                    const std::vector<int>& frames,
                    const std::function<std::filesystem::path(int)>& file) {
  Progress progress(drawing.progress, sides.scene.name, "drawing side by side",
                    static_cast<int>(frames.size()));
  SidePainter painter(sides, drawing.renderer);
  if (interrupted()) return false;
  const bool isWhole = drawApart(
      frames, drawing.threads, [&](int frame) { painter.draw(frame, file(frame)); },
      [&] { progress.advance(); });
  if (isWhole) progress.finish();
  return isWhole;
}

bool filmFrames(const std::filesystem::path& folder, const std::vector<int>& frames, int fps,
                const std::filesystem::path& file) {
  const int step = frames.size() > 1 ? frames[1] - frames[0] : 1;
  render::FilmOptions film;
  film.framesPerSecond = std::max(1, static_cast<int>(std::lround(1.0 * fps / step)));
  try {
    render::makeFilm(render::frameFiles(folder, frames.front(), frames.back(), step), file, film);
  } catch (const render::FilmError& error) {
    if (interrupted()) return false;
    throw EnvironmentError(error.what());
  }
  return true;
}

}  // namespace app
