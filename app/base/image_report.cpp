// A page of want / got / difference for images that were compared.
#include "app/base/image_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/base/html.h"
#include "app/base/output_file.h"
#include "render/png.h"

namespace app {

namespace {

std::string fileStem(const std::string& name) {
  std::string stem = name;
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return c == ' ' || c == '/' || c == '\\'; }, '_');
  return stem;
}

std::string figure(const render::Image& image, const std::string& file, const std::string& caption,
                   const std::filesystem::path& folder) {
  render::writePng(image, folder / file);
  return fmt::format("<figure><img src=\"{0}\" alt=\"{1}\"><figcaption>{1}</figcaption></figure>\n",
                     escapeHtml(file), escapeHtml(caption));
}

bool sameSize(const render::Image& a, const render::Image& b) {
  return a.width == b.width && a.height == b.height;
}

std::string section(const ImagePair& pair, const std::filesystem::path& folder) {
  const std::string stem = fileStem(pair.name);
  std::string html = fmt::format("<section><h2>{}</h2><p>{}</p><div class=\"three\">\n",
                                 escapeHtml(pair.name), escapeHtml(findings(pair)));
  if (exists(pair.want)) html += figure(pair.want, stem + "-want.png", "want", folder);
  if (exists(pair.got)) html += figure(pair.got, stem + "-got.png", "got", folder);
  if (exists(pair.want) && sameSize(pair.want, pair.got)) {
    html += figure(render::differenceImage(pair.want, pair.got), stem + "-difference.png",
                   "difference: orange is visible, dark red strong", folder);
  }
  return html + "</div></section>\n";
}

std::string table(const std::vector<ImagePair>& pairs) {
  std::string html = "<table><tr><th>image</th><th></th><th>result</th><th>what moved</th></tr>\n";
  for (const ImagePair& pair : pairs) {
    html += fmt::format("<tr><td>{}</td><td class=\"{}\">{}</td><td>{}</td><td>{}</td></tr>\n",
                        escapeHtml(pair.name), pair.passed ? "good" : "bad",
                        pair.passed ? "ok" : "FAIL", escapeHtml(findings(pair)),
                        escapeHtml(pair.remark));
  }
  return html + "</table>\n";
}

}  // namespace

bool exists(const render::Image& image) { return image.width > 0; }

ImagePair comparePair(std::string name, render::Image want, render::Image got) {
  ImagePair pair{std::move(name), std::move(want), std::move(got), {}, false, "", {}};
  if (exists(pair.want) && exists(pair.got)) {
    pair.comparison = render::compareImages(pair.want, pair.got);
    pair.passed = pair.comparison.passed;
    const bool looks = !pair.comparison.identical && sameSize(pair.want, pair.got);
    if (looks) pair.flip = render::flip(pair.want, pair.got);
  } else {
    pair.comparison.reason =
        exists(pair.want) ? "the image is missing" : "there is nothing to compare with";
  }
  return pair;
}

std::string findings(const ImagePair& pair) {
  if (!pair.flip) return pair.comparison.reason;
  return fmt::format("{}; FLIP mean {:.2g}, 95 % below {:.2g}", pair.comparison.reason,
                     pair.flip->mean, pair.flip->percentile95);
}

std::string describePair(const ImagePair& pair) {
  return fmt::format("{:<5} {:<24} {}{}\n", pair.passed ? "ok" : "FAIL", pair.name, findings(pair),
                     pair.remark.empty() ? "" : "; " + pair.remark);
}

std::filesystem::path writeImageReport(const std::string& title,
                                       const std::vector<ImagePair>& pairs,
                                       const std::filesystem::path& folder) {
  makeFolder(folder);
  const auto failed =
      std::count_if(pairs.begin(), pairs.end(), [](const ImagePair& pair) { return !pair.passed; });
  std::string body = fmt::format("<h1>{}</h1>\n<p class=\"quiet\">{} of {} images differ.</p>\n",
                                 escapeHtml(title), failed, pairs.size());
  for (const ImagePair& pair : pairs) {
    if (!pair.passed) body += section(pair, folder);
  }
  body += table(pairs);
  const std::filesystem::path page = folder / "index.html";
  writeFile(page, htmlPage(title, body));
  return page;
}

}  // namespace app
