// An element of a model as its reader asks for it: typed, checked, with the defaults of its class.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/models/model_survey.h"

namespace scenes {

class Tag {
 public:
  // Attributes that `own` lacks are those of `standard`, the nearest first.
  Tag(const XmlElement& own, ModelSurvey& survey, std::vector<const XmlElement*> standard = {});

  const Place& place() const { return own_.place; }
  const XmlElement& element() const { return own_; }
  ModelSurvey& survey() const { return survey_; }
  std::string name(const std::string& otherwise) const { return text("name", otherwise); }

  bool has(const char* key) const { return find(key) != nullptr; }
  std::optional<std::string> text(const char* key) const;
  std::string text(const char* key, const std::string& otherwise) const;
  std::optional<double> number(const char* key) const;
  double number(const char* key, double otherwise) const;
  std::vector<double> numbers(const char* key) const;  // none where absent
  std::vector<double> numbers(const char* key, std::size_t count) const;
  physics::Vec3 vector(const char* key, const physics::Vec3& otherwise) const;
  bool flag(const char* key, bool otherwise) const;  // "true" or "false"
  std::string choice(const char* key, std::span<const char* const> known,
                     const std::string& otherwise) const;
  std::string required(const char* key) const;

  [[noreturn]] void fail(const std::string& message) const;  // "<geom>: message" at its place
  void leaveOut(const std::string& what) const { survey_.leaveOut(what, place()); }

 private:
  const std::string* find(const char* key) const;
  const XmlElement& own_;
  ModelSurvey& survey_;
  std::vector<const XmlElement*> standard_;
};

// The children of an element with this tag; the element is seen.
std::vector<const XmlElement*> childrenOf(const XmlElement& element, const std::string& tag,
                                          ModelSurvey& survey);

}  // namespace scenes
