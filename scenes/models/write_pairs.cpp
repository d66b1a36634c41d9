// Which bodies of a model do not touch each other, as [[no_contact]].
#include <algorithm>
#include <set>

#include "scenes/models/write_bodies.h"

namespace scenes {
namespace {

bool touch(const ModelLink& link, const ModelPart& other) {
  return std::any_of(link.parts.begin(), link.parts.end(), [&](const ModelPart& one) {
    return (one.type & other.affinity) != 0 || (other.type & one.affinity) != 0;
  });
}

bool touch(const ModelLink& link, const ModelLink& other) {
  return std::any_of(other.parts.begin(), other.parts.end(),
                     [&](const ModelPart& part) { return touch(link, part); });
}

void writeApart(Written& written, const std::vector<std::string>& names, const Place& place) {
  const Words words{place};
  Value table = words.table();
  words.set(table, names.size() == 1 ? "body" : "bodies",
            names.size() == 1 ? words.text(names[0]) : words.texts(names));
  words.add(written.root, "no_contact", std::move(table));
}

std::vector<std::string> namesOf(const Written& written, const std::vector<int>& links) {
  std::set<std::string> names;
  for (const int link : links) {
    const int carrier = written.carrier[static_cast<std::size_t>(link)];
    const int from = carrier == kWorldLink ? link : carrier;
    const auto& own = written.names[static_cast<std::size_t>(from)];
    names.insert(own.begin(), own.end());
  }
  return {names.begin(), names.end()};
}

bool carries(const Written& written, std::size_t k) {
  return written.carrier[k] == static_cast<int>(k) && k != kWorldLink;
}

// Pairs of bodies none of whose shapes have bits that meet.
void writeBits(Written& written, std::size_t k) {
  const ModelLink& link = written.whole[k];
  for (std::size_t j = 0; j < written.whole.size(); ++j) {
    const ModelLink& other = written.whole[j];
    if (written.carrier[j] == kWorldLink) {
      for (std::size_t i = 0; i < other.parts.size(); ++i) {
        if (!other.parts[i].collides() || touch(link, other.parts[i])) continue;
        writeApart(written, {written.names[j][i], written.names[k][0]}, link.place);
      }
    } else if (j < k && carries(written, j) && !other.parts.empty() && !touch(link, other)) {
      writeApart(written, {written.names[j][0], written.names[k][0]}, link.place);
    }
  }
}

bool haveBits(const Written& written) {
  return std::any_of(written.whole.begin(), written.whole.end(), [](const ModelLink& link) {
    return std::any_of(link.parts.begin(), link.parts.end(),
                       [](const ModelPart& part) { return (part.type & part.affinity & 1) == 0; });
  });
}

}  // namespace

void writePairs(Written& written) {
  const Model& model = written.model;
  for (const std::vector<int>& links : model.apart) {
    const std::vector<std::string> names = namesOf(written, links);
    if (names.size() > 1) writeApart(written, names, model.place);
  }
  const bool bits = haveBits(written);
  for (std::size_t k = 1; k < written.whole.size(); ++k) {
    const ModelLink& link = written.whole[k];
    if (!carries(written, k) || link.parts.empty()) continue;
    const bool collides = std::any_of(link.parts.begin(), link.parts.end(),
                                      [](const ModelPart& part) { return part.collides(); });
    if (!collides) {
      writeApart(written, written.names[k], link.place);
      continue;
    }
    // Through its rings it is not joined to its parent.
    const int parent = written.carrier[static_cast<std::size_t>(link.parent)];
    if (link.joints.size() > 1 && parent != kWorldLink) {
      writeApart(written, namesOf(written, {parent, static_cast<int>(k)}), link.place);
    }
    if (bits) writeBits(written, k);
  }
}

}  // namespace scenes
