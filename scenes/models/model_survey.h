// What of a model was asked for, and what of it nobody asked for: no word of it is passed over in
// silence.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenes/models/xml.h"
#include "scenes/read/read_value.h"

namespace scenes {

class ModelSurvey {
 public:
  explicit ModelSurvey(const Context& context) : context_(context) {}

  const Context& context() const { return context_; }
  void asked(const std::string& tag, const std::string& attribute);
  void seen(const XmlElement& element);  // its attributes and children are of interest

  void seenWhole(const XmlElement& element);  // and all inside it

  // `what` is not read, and where; the same words are told once, with how often.
  void leaveOut(const std::string& what, const Place& place);
  void remark(const std::string& what, const Place& place);  // what its author may not expect

  void keep(std::shared_ptr<const XmlElement> root) { roots_.push_back(std::move(root)); }
  void compare();                         // leaves out what of the kept elements was not asked for
  std::vector<std::string> told() const;  // "humanoid.xml:18: not read: armature of <joint>, ..."

 private:
  struct Left {
    std::string what;  // "not read: ..."
    std::vector<Place> places;
  };
  void compare(const XmlElement& element);

  const Context& context_;
  std::vector<std::shared_ptr<const XmlElement>> roots_;
  std::set<std::pair<std::string, std::string>> asked_;
  std::set<const XmlElement*> seen_;
  std::vector<Left> left_;
  // Attributes that nobody asked for, by the tag of their elements.
  std::map<std::string, std::pair<std::set<std::string>, std::vector<Place>>> attributes_;
};

}  // namespace scenes
