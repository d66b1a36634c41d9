// MJCF: <site>, <tendon>: a string between two sites that pulls, or that is as long at the most.
#include <fmt/format.h>

#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

// Of sites that repeat each has its own, and so have the tendons between them.
std::vector<std::string> suffixesOf(const XmlElement& element, const Mjcf& mjcf) {
  for (const XmlElement& child : element.children) {
    const XmlAttribute* site = child.find("site");
    if (site == nullptr || mjcf.sites.contains(mjcf.named(site->text))) continue;
    const auto found = mjcf.repeated.find(site->text);
    if (found != mjcf.repeated.end()) return found->second;
  }
  return {""};
}

// False: it takes another way than straight from one site to the other.
bool readEnds(const XmlElement& element, const std::string& suffix, Mjcf& mjcf,
              ModelString& string) {
  std::vector<const XmlElement*> sites = childrenOf(element, "site", mjcf.survey);
  if (sites.size() != 2 || element.children.size() != 2) return false;
  for (std::size_t k = 0; k < 2; ++k) {
    const Tag tag(*sites[k], mjcf.survey);
    const std::string name = mjcf.named(tag.required("site"));
    auto found = mjcf.sites.find(name);
    if (found == mjcf.sites.end()) found = mjcf.sites.find(name + suffix);
    if (found == mjcf.sites.end()) tag.fail(fmt::format("no site '{}'", name));
    string.links[k] = found->second.link;
    string.at[k] = found->second.at;
  }
  return true;
}

void readRest(const Tag& tag, ModelString& string) {
  const std::vector<double> length = tag.numbers("springlength");
  if (length.empty() || length[0] < 0) return;  // as at the start
  string.rest = length[0];
  if (length.size() > 1 && length[1] != length[0]) {
    tag.leaveOut("a springlength from one number to another: the first counts");
  }
}

void readMost(const Tag& tag, const Mjcf& mjcf, ModelString& string) {
  const std::optional<std::array<double, 2>> range = rangeOf(tag, mjcf.compiler, 1);
  if (!range) return;
  string.most = (*range)[1];
  if ((*range)[0] > 0) tag.leaveOut("the least length of a <spatial>");
}

void readSpatial(const XmlElement& element, const std::string& suffix, Mjcf& mjcf) {
  const Tag tag = tagOf(element, mjcf);
  ModelString string;
  string.name = tag.text("name") ? mjcf.named(tag.name("")) + suffix : "";
  string.place = tag.place();
  if (!readEnds(element, suffix, mjcf, string)) {
    mjcf.survey.seenWhole(element);
    return tag.leaveOut("<spatial> but straight from a site to another");
  }
  string.stiffness = tag.number("stiffness", 0);
  string.damping = tag.number("damping", 0);
  if (string.stiffness < 0 || string.damping < 0) tag.fail("expected stiffness and damping >= 0");
  readRest(tag, string);
  readMost(tag, mjcf, string);
  if (string.links[0] != string.links[1]) mjcf.model.strings.push_back(std::move(string));
}

}  // namespace

void readTendons(Mjcf& mjcf) {
  for (const XmlElement* group : childrenOf(*mjcf.root, "tendon", mjcf.survey)) {
    for (const XmlElement* element : childrenOf(*group, "spatial", mjcf.survey)) {
      for (const std::string& suffix : suffixesOf(*element, mjcf)) {
        readSpatial(*element, suffix, mjcf);
      }
    }
    for (const XmlElement* element : childrenOf(*group, "fixed", mjcf.survey)) {
      mjcf.survey.seenWhole(*element);
      mjcf.survey.leaveOut("<fixed>, a tendon over several joints", element->place);
    }
  }
}

}  // namespace scenes
