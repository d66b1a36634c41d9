// index.html of the figures: picture, claim, what was measured, and whether it holds.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/base/html.h"
#include "app/base/output_file.h"
#include "app/figure/figure_record.h"
#include "app/run/run_page.h"
#include "scenes/joined.h"

namespace app {

namespace {

namespace fs = std::filesystem;

std::vector<FigureRecord> recordsIn(const fs::path& folder) {
  std::vector<FigureRecord> records;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    if (std::optional<FigureRecord> record = readFigureRecord(entry.path())) {
      records.push_back(std::move(*record));
    }
  }
  std::sort(records.begin(), records.end(), [](const FigureRecord& a, const FigureRecord& b) {
    const auto key = [](const FigureRecord& r) {
      return std::tuple(r.number == 0, r.number, r.name);
    };
    return key(a) < key(b);
  });
  return records;
}

std::string verdictOf(const FigureRecord& record) {
  if (!record.problem.empty()) return "<span class=\"bad\">The simulation failed</span>";
  if (record.measures.empty()) return "<span class=\"quiet\">Nothing is measured</span>";
  return record.holds() ? "<span class=\"good\">Holds</span>"
                        : "<span class=\"bad\">Does not hold</span>";
}

std::string heading(const FigureRecord& record) {
  const std::string title = escapeHtml(record.title);
  return record.number > 0 ? fmt::format("Figure {}: {}", record.number, title) : title;
}

std::string textOf(const Json& measure, const char* key) {
  return escapeHtml(measure.value(key, ""));
}

std::string measuresOf(const FigureRecord& record) {
  if (record.measures.empty()) return "";
  std::string html = "<table><tr><th>claim</th><th>measured</th><th>bound</th><th></th></tr>\n";
  for (const Json& measure : record.measures) {
    const bool holds = measure.value("holds", false);
    html +=
        fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"{}\">{}</td></tr>\n",
                    textOf(measure, "text"), textOf(measure, "measured"), textOf(measure, "bound"),
                    holds ? "good" : "bad", holds ? "holds" : "fails");
  }
  return html + "</table>\n";
}

std::string timesOf(const FigureRecord& record) {
  std::string times;
  for (const auto& [stage, seconds] : record.seconds.items()) {
    times += fmt::format("{}{} {:.1f} s", times.empty() ? "" : ", ", escapeHtml(stage),
                         seconds.get<double>());
  }
  return times;
}

std::string filesOf(const FigureRecord& record) {
  std::string links;
  for (const Json& file : record.files) {
    const std::string name = escapeHtml(file.get<std::string>());
    links += fmt::format("{}<a href=\"{}\">{}</a>", links.empty() ? "" : ", ", name, name);
  }
  return links;
}

// How its runs were stepped: one way, or several.
std::string methodsOf(const FigureRecord& record) {
  std::set<std::string> methods;
  for (const Json& scene : record.inputs.value("scenes", Json::array())) {
    methods.insert(scene.value("method", ""));
  }
  return scenes::joined(methods, "; ");
}

std::string showFigure(const FigureRecord& record) {
  const std::string picture = escapeHtml(record.name) + ".png";
  std::string html = fmt::format("<section id=\"{}\"><h2>{} · {}</h2>\n", escapeHtml(record.name),
                                 heading(record), verdictOf(record));
  html +=
      fmt::format("<p>{}</p>\n<a href=\"{}\"><img class=\"poster\" src=\"{}\" alt=\"{}\"></a>\n",
                  escapeHtml(record.claim), picture, picture, heading(record));
  const std::string film = record.name + ".mp4";
  if (std::find(record.files.begin(), record.files.end(), film) != record.files.end()) {
    html += fmt::format(
        "<p></p><video controls loop muted preload=\"none\" poster=\"{}\" "
        "src=\"{}\"></video>\n",
        picture, escapeHtml(film));
  }
  if (!record.problem.empty()) html += fmt::format("<p>{}</p>\n", escapeHtml(record.problem));
  html += "<p></p>\n" + measuresOf(record);
  html += fmt::format(
      "<p class=\"quiet\">Method: {}. Took: {}. Files: {}<br><code>dbd figures {} --fresh</code>"
      "</p>\n",
      escapeHtml(methodsOf(record)), timesOf(record), filesOf(record), escapeHtml(record.asked));
  return html + "</section>\n";
}

std::string contents(const std::vector<FigureRecord>& records) {
  std::string html = "<section><table>\n";
  for (const FigureRecord& record : records) {
    html += fmt::format("<tr><td><a href=\"#{}\">{}</a></td><td class=\"number\">{}</td></tr>\n",
                        escapeHtml(record.name), heading(record), verdictOf(record));
  }
  return html + "</table></section>\n";
}

std::string showFigures(const std::vector<FigureRecord>& records) {
  if (records.empty()) return "";
  std::string html =
      "<h1 id=\"figures\">The figures</h1>\n<p class=\"quiet\">What the paper says each shows, "
      "what "
      "was measured, and whether that holds.</p>\n" +
      contents(records);
  for (const FigureRecord& record : records) html += showFigure(record);
  return html;
}

// What was rendered into DIR/scenes, as app/run.sh does.
std::string showScenes(const fs::path& folder) {
  if (!fs::is_directory(folder / "scenes")) return "";
  const std::string runs = showRuns(runFolders(folder / "scenes"), "scenes/");
  return runs.empty()
             ? ""
             : "<h1 id=\"scenes\">Scenes of the library</h1>\n<p class=\"quiet\">What each "
               "expects of itself was checked along its whole run.</p>\n" +
                   runs;
}

// A study below DIR, as app/run.sh makes it.
struct ShownStudy {
  const char *folder, *title, *text;
};
constexpr ShownStudy kStudies[] = {
    {"study", "What accuracy costs in time",
     "Errors against wall times of every method and of other engines, measured on this machine."},
    {"study_effects", "What each effect costs",
     "What a scene's step saves without each of its effects, and what the program leaves out."},
};

// A link, and the first diagrams.
std::string showStudy(const fs::path& folder, const ShownStudy& study) {
  if (!fs::exists(folder / study.folder / "index.html")) return "";
  std::vector<std::string> diagrams;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / study.folder)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".svg" && !stem.ends_with("_h")) diagrams.push_back(stem);
  }
  std::sort(diagrams.begin(), diagrams.end());
  constexpr std::size_t kMost = 4;
  diagrams.resize(std::min(diagrams.size(), kMost));
  std::string html = fmt::format(
      "<section id=\"{0}\"><h2><a href=\"{0}/index.html\">{1}</a></h2>\n<p>{2}</p>\n"
      "<div class=\"shots\">\n",
      study.folder, study.title, study.text);
  for (const std::string& name : diagrams) {
    html += fmt::format(
        "<a href=\"{0}/index.html#{1}\"><img class=\"poster\" src=\"{0}/{1}.svg\" "
        "alt=\"{1}\"></a>\n",
        study.folder, escapeHtml(name));
  }
  return html + "</div></section>\n";
}

// The hard cases of DIR/stability: a link, and how some of them end.
std::string showStability(const fs::path& folder) {
  constexpr std::size_t kMost = 4;
  std::error_code error;
  std::vector<std::string> ends;
  for (const auto& entry : fs::directory_iterator(folder / "stability" / "ends", error)) {
    ends.push_back(entry.path().filename().string());
  }
  if (ends.empty()) return "";
  std::sort(ends.begin(), ends.end());
  ends.resize(std::min(ends.size(), kMost));
  std::string html =
      "<section id=\"stability\"><h2><a href=\"stability/index.html\">Hard cases stay "
      "stable</a></h2>\n<p>Large mass ratios, high stacks, fast impacts: whether each criterion "
      "holds, and by which margin.</p>\n<div class=\"shots\">\n";
  for (const std::string& name : ends) {
    html += fmt::format("<img class=\"poster\" src=\"stability/ends/{}\" alt=\"\">\n",
                        escapeHtml(name));
  }
  return html + "</div></section>\n";
}

}  // namespace

bool holdsParts(const fs::path& folder) {
  return fs::is_directory(folder / "scenes") || !recordsIn(folder).empty();
}

fs::path writeFigurePage(const fs::path& folder) {
  struct Part {
    std::string id, name, html;
  };
  std::vector<Part> parts{{"scenes", "Films", showScenes(folder)},
                          {"figures", "The paper's figures", showFigures(recordsIn(folder))}};
  for (const ShownStudy& study : kStudies) {
    parts.push_back({study.folder, study.title, showStudy(folder, study)});
  }
  parts.push_back({"stability", "Hard cases", showStability(folder)});
  std::erase_if(parts, [](const Part& part) { return part.html.empty(); });
  std::string links, body;
  for (const Part& part : parts) {
    links +=
        fmt::format("{}<a href=\"#{}\">{}</a>", links.empty() ? "" : " · ", part.id, part.name);
    body += part.html;
  }
  const fs::path page = folder / "index.html";
  writeFile(page, htmlPage("Displacement based dynamics",
                           "<h1>Displacement based dynamics</h1>\n<p class=\"quiet\">Simulated, "
                           "measured and drawn on this machine.</p>\n<p>" +
                               links + "</p>\n" + body));
  return page;
}

}  // namespace app
