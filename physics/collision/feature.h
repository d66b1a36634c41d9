// Which features of two bodies a contact point is of, as a number: the same from step to step.
#pragma once

#include <cstdint>

namespace physics::collision {

enum class Owner { a, b };  // whose face is flat: its normal is the contact's

// Tags in the two top bits but one; the top bit tells the owner of a facet.
constexpr std::uint32_t kFacetTag = 0u << 29, kLinesTag = 1u << 29, kPointTag = 2u << 29,
                        kTags = 3u << 29, kOwnedByA = 1u << 31;

// `id`: of a corner of the other's patch.
inline std::uint32_t facetFeature(Owner owner, int index, std::uint32_t id) {
  return kFacetTag | (owner == Owner::a ? kOwnedByA : 0u) |
         (static_cast<std::uint32_t>(index) & 0xfff) << 17 | id;
}
inline bool isOfFacet(std::uint32_t feature) { return (feature & kTags) == kFacetTag; }
inline Owner facetOwnerOf(std::uint32_t feature) {
  return (feature & kOwnedByA) != 0 ? Owner::a : Owner::b;
}

// The same of the k-th part of a mesh.
inline std::uint32_t featureOfPart(std::uint32_t feature, int k) {
  return feature ^ (static_cast<std::uint32_t>(k) * 2654435761u & ~(kTags | kOwnedByA));
}

}  // namespace physics::collision
