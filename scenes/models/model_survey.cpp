// What of a model was asked for, and what of it nobody asked for.
#include "scenes/models/model_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "scenes/joined.h"

namespace scenes {
namespace {

constexpr std::size_t kMostLines = 3;  // told of each; then their number

std::string linesOf(const std::vector<Place>& places) {
  std::string text;
  for (std::size_t i = 1; i < std::min(places.size(), kMostLines); ++i) {
    text += fmt::format("{}{}", i == 1 ? "also line " : ", ", places[i].line);
  }
  if (places.size() > kMostLines) text += fmt::format(" and {} more", places.size() - kMostLines);
  return text.empty() ? "" : " (" + text + ")";
}

}  // namespace

void ModelSurvey::asked(const std::string& tag, const std::string& attribute) {
  asked_.emplace(tag, attribute);
}

void ModelSurvey::seen(const XmlElement& element) { seen_.insert(&element); }

void ModelSurvey::seenWhole(const XmlElement& element) {
  seen(element);
  for (const XmlAttribute& attribute : element.attributes) asked(element.tag, attribute.name);
  for (const XmlElement& child : element.children) seenWhole(child);
}

void ModelSurvey::leaveOut(const std::string& what, const Place& place) {
  remark("not read: " + what, place);
}

void ModelSurvey::remark(const std::string& what, const Place& place) {
  const auto same = [&](const Left& left) { return left.what == what; };
  auto found = std::find_if(left_.begin(), left_.end(), same);
  if (found == left_.end()) found = left_.insert(left_.end(), {what, {}});
  found->places.push_back(place);
}

void ModelSurvey::compare() {
  for (const auto& root : roots_) compare(*root);
  for (const auto& [tag, found] : attributes_) {
    const auto& [names, places] = found;
    const std::string what = fmt::format("not read: {} of <{}>", joined(names, ", "), tag);
    for (const Place& place : places) remark(what, place);
  }
  attributes_.clear();
}

void ModelSurvey::compare(const XmlElement& element) {
  if (!seen_.contains(&element)) {
    leaveOut(fmt::format("<{}>", element.tag), element.place);
    return;
  }
  for (const XmlAttribute& attribute : element.attributes) {
    if (asked_.contains({element.tag, attribute.name})) continue;
    auto& [names, places] = attributes_[element.tag];
    names.insert(attribute.name);
    const bool again = !places.empty() && places.back().line == element.place.line &&
                       places.back().file == element.place.file;
    if (!again) places.push_back(element.place);
  }
  for (const XmlElement& child : element.children) compare(child);
}

std::vector<std::string> ModelSurvey::told() const {
  std::vector<Left> sorted = left_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Left& a, const Left& b) {
    const Place &first = a.places.front(), &second = b.places.front();
    return std::tie(first.file, first.line) < std::tie(second.file, second.line);
  });
  std::vector<std::string> lines;
  for (const Left& left : sorted) {
    const Place& first = left.places.front();
    lines.push_back(fmt::format("{}:{}: {}{}", first.file.empty() ? context_.path : first.file,
                                first.line, left.what, linesOf(left.places)));
  }
  return lines;
}

}  // namespace scenes
