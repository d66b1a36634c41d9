// An element of a model as its reader asks for it.
#include "scenes/models/tag.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace scenes {
namespace {

constexpr double kMost = 1e100;  // what is squared must stay a number

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// False where a word is no number.
bool readNumbers(const std::string& text, std::vector<double>& out) {
  const char *at = text.data(), *end = text.data() + text.size();
  while (true) {
    while (at != end && isSpace(*at)) ++at;
    if (at == end) return true;
    if (*at == '+') ++at;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !(std::abs(value) <= kMost)) return false;
    if (next != end && !isSpace(*next)) return false;
    out.push_back(value);
    at = next;
  }
}

}  // namespace

Tag::Tag(const XmlElement& own, ModelSurvey& survey, std::vector<const XmlElement*> standard)
    : own_(own), survey_(survey), standard_(std::move(standard)) {
  survey.seen(own);
}

const std::string* Tag::find(const char* key) const {
  survey_.asked(own_.tag, key);
  if (const XmlAttribute* own = own_.find(key)) return &own->text;
  for (const XmlElement* element : standard_) {
    survey_.asked(element->tag, key);
    if (const XmlAttribute* found = element->find(key)) return &found->text;
  }
  return nullptr;
}

std::optional<std::string> Tag::text(const char* key) const {
  const std::string* found = find(key);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

std::string Tag::text(const char* key, const std::string& otherwise) const {
  return text(key).value_or(otherwise);
}

std::string Tag::required(const char* key) const {
  const auto found = text(key);
  if (!found) fail(fmt::format("expected the attribute '{}'", key));
  return *found;
}

std::vector<double> Tag::numbers(const char* key) const {
  std::vector<double> values;
  const std::string* found = find(key);
  if (found != nullptr && !readNumbers(*found, values)) {
    fail(fmt::format("{}: expected numbers, got '{}'", key, found->substr(0, 60)));
  }
  return values;
}

std::vector<double> Tag::numbers(const char* key, std::size_t count) const {
  const std::vector<double> values = numbers(key);
  if (has(key) && values.size() != count) {
    fail(fmt::format("{}: expected {} number{}, got {}", key, count, count == 1 ? "" : "s",
                     values.size()));
  }
  return values;
}

std::optional<double> Tag::number(const char* key) const {
  const std::vector<double> values = numbers(key, 1);
  return values.empty() ? std::nullopt : std::optional(values[0]);
}

double Tag::number(const char* key, double otherwise) const {
  return number(key).value_or(otherwise);
}

physics::Vec3 Tag::vector(const char* key, const physics::Vec3& otherwise) const {
  const std::vector<double> values = numbers(key, 3);
  return values.empty() ? otherwise : physics::Vec3(values[0], values[1], values[2]);
}

bool Tag::flag(const char* key, bool otherwise) const {
  static constexpr const char* kFlags[] = {"true", "false", "1", "0"};
  const std::string word = choice(key, kFlags, otherwise ? "true" : "false");
  return word == "true" || word == "1";
}

std::string Tag::choice(const char* key, std::span<const char* const> known,
                        const std::string& otherwise) const {
  const std::string* found = find(key);
  if (found == nullptr) return otherwise;
  const std::vector<std::string> words(known.begin(), known.end());
  for (const std::string& word : words) {
    if (word == *found) return word;
  }
  fail(fmt::format("{}: unknown '{}'{}", key, *found, nearestOrAll(*found, words)));
}

void Tag::fail(const std::string& message) const {
  scenes::fail(survey_.context(), place(), fmt::format("<{}>: {}", own_.tag, message));
}

std::vector<const XmlElement*> childrenOf(const XmlElement& element, const std::string& tag,
                                          ModelSurvey& survey) {
  survey.seen(element);
  std::vector<const XmlElement*> found;
  for (const XmlElement& child : element.children) {
    if (child.tag == tag) found.push_back(&child);
  }
  return found;
}

}  // namespace scenes
