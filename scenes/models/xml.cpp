// XML text -> elements; the only file that knows pugixml.
#include "scenes/models/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <string_view>

namespace scenes {
namespace {

// Elements in elements are walked by recursion: robots have some thirty links in a row.
constexpr int kMostDepth = 500;

class Lines {
 public:
  explicit Lines(const std::string& text) : text_(text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') starts_.push_back(i + 1);
    }
  }
  Place at(std::ptrdiff_t offset, const std::string& file) const {
    const auto where =
        std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)), text_.size());
    const auto next = std::upper_bound(starts_.begin(), starts_.end(), where);
    const auto line = next - starts_.begin();
    const std::size_t start = line == 0 ? 0 : starts_[static_cast<std::size_t>(line - 1)];
    return {static_cast<int>(line) + 1, static_cast<int>(where - start) + 1, {}, file};
  }

 private:
  const std::string& text_;
  std::vector<std::size_t> starts_;  // of every line but the first
};

[[noreturn]] void refuse(const std::string& path, const Place& place, const std::string& message) {
  throw InputError(fmt::format("{}:{}:{}: {}", path, place.line, place.column, message));
}

struct Converter {
  const Lines& lines;
  const std::string &path, &file;

  XmlElement element(const pugi::xml_node& node, int depth) const {
    XmlElement out{node.name(), lines.at(node.offset_debug(), file), {}, {}};
    if (depth > kMostDepth) {
      refuse(path, out.place,
             fmt::format("expected at most {} elements inside each other", kMostDepth));
    }
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      if (out.find(attribute.name()) != nullptr) {
        refuse(path, out.place,
               fmt::format("<{}>: the attribute '{}' is there twice", out.tag, attribute.name()));
      }
      out.attributes.push_back({attribute.name(), attribute.value()});
    }
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() == pugi::node_element) out.children.push_back(element(child, depth + 1));
    }
    return out;
  }
};

}  // namespace

const XmlAttribute* XmlElement::find(const std::string& name) const {
  for (const XmlAttribute& attribute : attributes) {
    if (attribute.name == name) return &attribute;
  }
  return nullptr;
}

XmlElement parseXml(const std::string& text, const std::string& path, const std::string& file) {
  checkLetters(text, path);
  const Lines lines(text);
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    refuse(path, lines.at(result.offset, file),
           fmt::format("expected XML: {}", result.description()));
  }
  const pugi::xml_node root = document.document_element();
  if (!root) refuse(path, {1, 1}, "expected XML with an element");
  return Converter{lines, path, file}.element(root, 0);
}

}  // namespace scenes
