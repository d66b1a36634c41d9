// XML text -> elements that remember where they were written.
#pragma once

#include <string>
#include <vector>

#include "scenes/read/value.h"

namespace scenes {

struct XmlAttribute {
  std::string name, text;
};

struct XmlElement {
  std::string tag;
  Place place;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;
  const XmlAttribute* find(const std::string& name) const;  // null where absent
};

// The root of `text`. Throws InputError("path:line:col: expected ...") where it is none. `file` is
// what places name, where it is not the scene's own file.
XmlElement parseXml(const std::string& text, const std::string& path, const std::string& file = "");

}  // namespace scenes
