// Charts of a difference over time, and the files they are among.
#pragma once

#include <filesystem>
#include <string>

#include "app/trust/trust.h"
#include "render/chart.h"
#include "render/page.h"

namespace app {

// The largest distance of a body by what it is allowed, and that of the body that parts first, over
// time; what is allowed is 1, and a line stands where trust ends.
render::Chart trustChart(const Trust& trust);

// The largest distance of a centre [m] over time.
render::Chart divergeChart(const std::vector<FrameDifference>& differences);

// trust.json and difference.csv.
void writeTrust(const Trust& trust, const std::filesystem::path& folder);

// difference.png. As the next one to be called when nothing more is drawn in processes of its own
// (run/crew.h): what draws here leaves a thread that Mesa keeps its shaders by.
void drawTrustChart(const Trust& trust, const std::filesystem::path& folder);

// A page with a title and charts one above the other, into a PNG.
void writeCharts(const std::string& title, const std::vector<render::Chart>& charts,
                 const std::filesystem::path& file);

}  // namespace app
