// Reports as pages and files.
#include "app/study/report.h"

#include <fmt/format.h>

#include "app/base/build_info.h"
#include "app/base/console.h"
#include "app/base/gnuplot.h"
#include "app/base/html.h"
#include "app/base/machine.h"
#include "app/base/output_file.h"
#include "app/peers/peer.h"
#include "app/base/numbers.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using Look = ReportCell::Look;

constexpr const char* kClasses[] = {"", "number", "quiet", "good", "bad"};

std::string words(const std::string& text) { return escapeHtml(superscript(text)); }

// "<td class="quiet">": an element with the look of its text.
std::string opened(const char* element, Look look) {
  const std::string name = kClasses[static_cast<int>(look)];
  return name.empty() ? fmt::format("<{}>", element)
                      : fmt::format("<{} class=\"{}\">", element, name);
}

std::string folded(const std::string& summary, const std::string& html) {
  if (summary.empty() || html.empty()) return html;
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", words(summary), html);
}

struct ToHtml {
  const fs::path& folder;
  bool plotted;

  std::string operator()(const ReportText& text) const {
    std::string html = words(text.text);
    if (text.isCode) html = "<code>" + html + "</code>";
    if (!text.file.empty()) html += fmt::format(" <a href=\"{0}\">{0}</a>", text.file);
    return opened("p", text.look) + html + "</p>\n";
  }
  std::string operator()(const ReportTable& table) const {
    std::string html = "<table><tr>";
    for (const std::string& head : table.heads) html += "<th>" + words(head) + "</th>";
    html += "</tr>\n";
    for (const std::vector<ReportCell>& row : table.rows) {
      html += "<tr>";
      for (const ReportCell& cell : row) {
        const std::string text = words(cell.text);
        html += opened("td", cell.look) +
                (cell.link.empty()
                     ? text
                     : fmt::format("<a href=\"#{}\">{}</a>", escapeHtml(cell.link), text)) +
                "</td>";
      }
      html += "</tr>\n";
    }
    return folded(table.foldedUnder, html + "</table>\n");
  }
  std::string operator()(const ReportShots& shots) const {
    std::string html;
    for (const auto& [file, caption] : shots.files) {
      if (!fs::exists(folder / file)) continue;
      html += fmt::format(
          "<figure><img class=\"poster\" src=\"{}\" alt=\"\"><figcaption>{}</figcaption>"
          "</figure>\n",
          escapeHtml(file), words(caption));
    }
    if (html.empty()) return "";
    return folded(shots.foldedUnder, "<div class=\"shots\">\n" + html + "</div>\n");
  }
  std::string operator()(const Chart& chart) const {
    if (!plotted) return "";
    return fmt::format(
        "<figure><a href=\"{0}.png\"><img class=\"poster\" src=\"{0}.svg\" alt=\"{1}\"></a>{2}"
        "</figure>\n",
        escapeHtml(chart.name), escapeHtml(chart.alt),
        chart.caption.empty() ? "" : "<figcaption>" + words(chart.caption) + "</figcaption>");
  }
};

std::string sectionHtml(const ReportSection& section, const ToHtml& toHtml) {
  std::string html = section.isHead ? ""
                     : section.id.empty()
                         ? "<section>"
                         : fmt::format("<section id=\"{}\">", escapeHtml(section.id));
  if (!section.title.empty()) html += "<h2>" + words(section.title) + "</h2>\n";
  for (const ReportBlock& block : section.blocks) html += std::visit(toHtml, block);
  return html + (section.isHead ? "" : "</section>\n");
}

std::string machineText() {
  std::string text = fmt::format("{}, {} threads; dbd {}, {}", processorName(), processorCount(),
                                 version(), compiler());
  for (const PeerEngine& engine : peerEngines()) {
    text += engine.version.empty() ? fmt::format("; {} was not there when dbd was built ({})",
                                                 engine.name, engine.package)
                                   : fmt::format("; {} {}", engine.name, engine.version);
  }
  return text;
}

// False: there is no gnuplot.
bool drawCharts(const Report& report, const fs::path& folder) {
  static const bool hasGnuplot = !gnuplotVersion().empty();
  bool hasChart = false;
  for (const ReportSection& section : report.sections) {
    for (const ReportBlock& block : section.blocks) {
      const Chart* chart = std::get_if<Chart>(&block);
      hasChart = hasChart || chart != nullptr;
      if (chart != nullptr && hasGnuplot) drawChart(*chart, folder);
    }
  }
  if (hasChart && !hasGnuplot) note(kNoGnuplot);
  return hasGnuplot;
}

}  // namespace

ReportCell number(std::string text) { return {std::move(text), Look::kNumber}; }

std::string csvCell(std::string text) {
  for (char& c : text) {
    if (c == ',') c = ';';
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

fs::path writeReport(const Report& report, const fs::path& folder) {
  for (const auto& [name, text] : report.tables) writeFile(folder / name, text);
  const ToHtml toHtml{folder, drawCharts(report, folder)};
  std::string body =
      fmt::format("<h1>{}</h1>\n<p class=\"quiet\">{}{}.<br><code>{}</code></p>\n",
                  words(report.title), escapeHtml(machineText()),
                  report.note.empty() ? "" : "; " + words(report.note), escapeHtml(report.command));
  for (const ReportSection& section : report.sections) body += sectionHtml(section, toHtml);
  const fs::path page = folder / "index.html";
  writeFile(page, htmlPage(report.title, body));
  return page;
}

}  // namespace app
