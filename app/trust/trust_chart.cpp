// Lays out charts of a difference over time.
#include "app/trust/trust_chart.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/output_file.h"
#include "render/png.h"

namespace app {

namespace {

const render::Color kAll{0.55f, 0.56f, 0.60f, 1}, kFirst{0.00f, 0.35f, 0.70f, 1};
const render::Color kAllowed{0.12f, 0.12f, 0.13f, 1}, kEnd{0.84f, 0.10f, 0.12f, 1};

}  // namespace

render::Chart trustChart(const Trust& trust) {
  render::Chart chart;
  chart.x.title = "time [s]";
  chart.y.title = "difference / allowed";
  chart.y.logarithmic = true;
  render::ChartCurve all{"the body furthest apart", {}, kAll};
  double low = 1, high = 1;
  for (const FrameDifference& d : trust.differences) {
    all.points.push_back({d.time, d.ratio()});
    if (d.ratio() > 0) low = std::min(low, d.ratio()), high = std::max(high, d.ratio());
  }
  const double last = trust.differences.empty() ? 1 : trust.differences.back().time;
  chart.curves.push_back(std::move(all));
  if (!trust.isWhole()) {
    const physics::BodyId body = trust.differences[trust.beyond].body;
    const Allowed& allowed = trust.allowed[body];
    render::ChartCurve first{trust.track.names[body] + ", first apart", {}, kFirst};
    for (int f = 0; f < trust.frames(); ++f) {
      const double distance = apart(trust.track.frames[f].poses[body],
                                    trust.finer.frames[f].poses[body], allowed.radius);
      first.points.push_back({trust.differences[f].time, distance / allowed.distance});
    }
    chart.curves.push_back(std::move(first));
  }
  chart.curves.push_back({"allowed", {{0, 1}, {last, 1}}, kAllowed, true, true});
  if (!trust.isWhole()) {
    const double until = trust.until();
    chart.curves.push_back({fmt::format("trusted until t = {:.2f} s", until),
                            {{until, low}, {until, high}},
                            kEnd,
                            true,
                            true});
  }
  chart.x.low = 0;
  chart.x.high = last;
  return chart;
}

render::Chart divergeChart(const std::vector<FrameDifference>& differences) {
  render::Chart chart;
  chart.x.title = "time [s]";
  chart.y.title = "largest distance of a centre [m]";
  chart.y.logarithmic = true;
  chart.x.low = 0;
  if (!differences.empty()) chart.x.high = std::max(differences.back().time, 1e-9);
  render::ChartCurve curve{"", {}, kFirst};
  for (const FrameDifference& d : differences) curve.points.push_back({d.time, d.distance});
  chart.curves.push_back(std::move(curve));
  return chart;
}

void writeCharts(const std::string& title, const std::vector<render::Chart>& charts,
                 const std::filesystem::path& file) {
  constexpr int kWidth = 1280, kHeight = 480, kTitle = 60;
  constexpr float kTextSize = 24;
  render::Page page;
  page.width = kWidth;
  page.height = kTitle + kHeight * static_cast<int>(charts.size());
  page.texts.push_back({{24, 40}, title, 28, 0, {0.1f, 0.1f, 0.11f, 1}, false});
  float top = kTitle;
  for (const render::Chart& chart : charts) {
    page.plots.push_back({{12, top}, {kWidth - 12, top + kHeight - 8}, chart, kTextSize});
    top += kHeight;
  }
  render::writePng(render::PagePrinter().print(page), file);
}

void writeTrust(const Trust& trust, const std::filesystem::path& folder) {
  writeFile(folder / "trust.json", jsonText(trustJson(trust), 1) + "\n");
  writeFile(folder / "difference.csv", trustCsv(trust));
}

void drawTrustChart(const Trust& trust, const std::filesystem::path& folder) {
  writeCharts(fmt::format("{}: accuracy {:g} beside {:g}", trust.plan.scene.name,
                          trust.plan.accuracy, trust.plan.accuracy / 10),
              {trustChart(trust)}, folder / "difference.png");
}

}  // namespace app
