// Where the rows of a batch's contacts lie: in blocks that may be swept at a time.
#include <algorithm>
#include <bit>
#include <utility>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Bits of a word; the last one is for what a body with more contacts has left.
constexpr int kColours = 64;
// By points, and by whether it carried.
constexpr int kSorts = 2 * ContactBlock::kPoints;
// Contacts are dealt to threads by parts of so many; of more parts, more lie between them.
constexpr int kLeastOfPart = 2048, kMostLevels = 5;

// The last colour of each group is the overflow: a block each.
int laneStride(int list) { return list % kColours == kColours - 1 ? ContactBlock::kLanes : 1; }

// Halvings of a batch with so many contacts.
int levelsOf(int count) {
  int levels = 0;
  while (levels < kMostLevels && count >> (levels + 1) >= kLeastOfPart) ++levels;
  return levels;
}

// Groups in the order in which they are swept, by nested dissection (George 1973): the parts, what
// crosses from one to its neighbour, what crosses between these two and the next two, and so on to
// the first cut; what responds; and by parts what meets that which does not move, and of that what
// responds. Groups of a stage share no body that moves.
struct GroupOrder {
  int levels;
  int parts() const { return 1 << levels; }
  int stages() const { return levels + 4; }
  int responding() const { return levels + 1; }  // the stage, as the next two
  int fixed() const { return levels + 2; }
  int respondingFixed() const { return levels + 3; }
  int first(int stage) const {  // group
    if (stage <= responding()) return 2 * parts() - (2 * parts() >> stage);
    return stage == fixed() ? 2 * parts() : 3 * parts() + (stage - respondingFixed());
  }
  int count() const { return first(stages()); }
};

}  // namespace

void SmallSteps::Batch::layNothing() {
  slots.assign(1, kWorldBody);
  groups.assign(1, 0);
  stages.clear();
  blocks.clear();
  sliding.clear();
  lanes.clear();
}

// What one contact moves: a body, or all of an articulation that responds.
BodyId SmallSteps::Impl::leaderOf(BodyId i) const {
  const int k = articulationOf[i];
  return k >= 0 && responding[k] ? articulations[k].bodies().front() : i;
}

// A slot to every body, where it meets anything; those of a part follow each other.
void SmallSteps::Impl::takeSlots(Model& w, Batch& batch, int levels) {
  batch.slots.assign(1, kWorldBody);
  batch.slots.insert(batch.slots.end(), batch.bodies.begin(), batch.bodies.end());
  bisection.divide(w.bodies.pose, levels, std::span(batch.slots).subspan(1), w.workers);
  for (std::size_t s = 1; s < batch.slots.size(); ++s) slotOf[batch.slots[s]] = static_cast<int>(s);
  batch.motions.resize(batch.slots.size());
  batch.masses.resize(batch.slots.size());
  batch.inverses.resize(batch.slots.size());
  batch.before.resize(batch.slots.size());
}

// The bodies of a lane, once it has its contact.
void SmallSteps::Impl::takeSlots(const Bodies& b, ContactBlock& block, int l) const {
  if (block.contact[l] < 0) return emptyLane(block, l);
  const KeptContact& c = contacts[block.contact[l]];
  block.bodyA[l] = isMovable(b, c.a) ? slotOf[c.a] : 0;
  block.bodyB[l] = isMovable(b, c.b) ? slotOf[c.b] : 0;
}

// What meets may be another corner or all of a face a substep later, where bodies go far.
SmallSteps::Impl::Place SmallSteps::Impl::placeOf(const Bodies& b, int contact, int levels) const {
  const GroupOrder order{levels};
  const KeptContact& c = contacts[contact];
  const bool slides = !sliding.empty() && sliding[contact] != 0;
  const bool movesA = b.inverse[c.a].m > 0, movesB = b.inverse[c.b].m > 0;
  const auto partOf = [&](BodyId i) { return bisection.partOf(slotOf[i] - 1); };
  Place place;
  if (movesA) place.slotA = slotOf[leaderOf(c.a)];
  if (movesB) place.slotB = slotOf[leaderOf(c.b)];
  const bool isFixed = !movesA || !movesB;
  place.points = slides ? ContactBlock::kPoints : std::max(c.count, 1);
  place.sort = (c.isLoaded() ? 1 : 2) * ContactBlock::kPoints - place.points;
  if (meetsResponse(c)) {
    place.stage = isFixed ? order.respondingFixed() : order.responding();
    place.group = order.first(place.stage);
  } else if (isFixed) {
    place.stage = order.fixed();
    place.group = order.first(place.stage) + partOf(movesA ? c.a : c.b);
  } else {
    const int part = partOf(c.a);
    place.stage = std::bit_width(static_cast<unsigned>(part ^ partOf(c.b)));
    place.group = order.first(place.stage) + (part >> place.stage);
  }
  return place;
}

// The first that no other contact of its bodies has in this stage; their words begin at `taken`.
int SmallSteps::Impl::colourOf(const Place& place, std::uint64_t* taken) {
  std::uint64_t none = 0;  // of what does not move
  std::uint64_t& ofA = place.slotA > 0 ? taken[place.slotA] : none;
  std::uint64_t& ofB = place.slotB > 0 ? taken[place.slotB] : none;
  const int colour = std::min(std::countr_one(ofA | ofB), kColours - 1);
  ofA |= std::uint64_t{1} << colour;
  ofB |= std::uint64_t{1} << colour;
  return colour;
}

// f(group) of the groups of all stages, as sweeps deal them.
template <class F>
void SmallSteps::Impl::forEachPlanned(Model& w, int levels, F&& f) {
  const GroupOrder order{levels};
  for (int stage = 0; stage < order.stages(); ++stage) {
    const int first = order.first(stage);
    w.workers.forEachChunk(order.first(stage + 1) - first, 1, [&](int from, int to) {
      for (int group = first + from; group < first + to; ++group) f(group);
    });
  }
}

// Contacts by group, in their order.
void SmallSteps::Impl::groupContacts(Model& w, const Batch& batch, int levels) {
  const int count = static_cast<int>(batch.contacts.size());
  places.resize(batch.contacts.size());
  w.workers.forEachChunk(count, kLeastContacts, [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      places[i] = placeOf(w.bodies, batch.contacts[i], levels);
    }
  });
  groupEnd.assign(GroupOrder{levels}.count(), 0);
  for (const Place& place : places) ++groupEnd[place.group];
  int sum = 0;
  for (int& end : groupEnd) end = std::exchange(sum, sum + end);
  inGroup.resize(batch.contacts.size());
  for (int i = 0; i < count; ++i) inGroup[groupEnd[places[i].group]++] = i;
}

// The first lane of each list, and groups and stages of those that there are. Returned: lanes.
int SmallSteps::Impl::countLanes(Batch& batch, int levels) {
  constexpr int kLanes = ContactBlock::kLanes;
  const GroupOrder order{levels};
  batch.groups.assign(1, 0);
  batch.stages.clear();
  int lanes = 0;
  for (int stage = 0; stage < order.stages(); ++stage) {
    const int first = static_cast<int>(batch.groups.size()) - 1;
    for (int group = order.first(stage); group < order.first(stage + 1); ++group) {
      if (groupColours[group] == 0) continue;
      for (std::uint64_t left = groupColours[group]; left != 0; left &= left - 1) {
        const int list = group * kColours + std::countr_zero(left);
        for (int k = list * kSorts; k < (list + 1) * kSorts; ++k) {
          lanes += std::exchange(firstOf[k], lanes) * laneStride(list);
        }
        lanes = (lanes + kLanes - 1) / kLanes * kLanes;
      }
      batch.groups.push_back(lanes / kLanes);
    }
    const int end = static_cast<int>(batch.groups.size()) - 1;
    const bool responds = stage == order.responding() || stage == order.respondingFixed();
    if (end > first) batch.stages.push_back({first, end, responds});
  }
  return lanes;
}

// Contacts of one colour share no body that moves. First those of two bodies that move, then those
// with what does not, so that a sweep ends with nothing driven into a wall. A body with more
// contacts than there are colours has the others one by one. Of a colour those that carried come
// first, and of these those with most points: a block takes as long as its largest manifold, and
// where none carries it has no friction.
void SmallSteps::Impl::layOut(Model& w, Batch& batch) {
  constexpr int kLanes = ContactBlock::kLanes;
  forgetResponses(batch);
  if (batch.contacts.empty()) return batch.layNothing();
  const int levels = levelsOf(static_cast<int>(batch.contacts.size()));
  const GroupOrder order{levels};
  takeSlots(w, batch, levels);
  const bool isAlone = !batch.isMixed() && batch.softPairs.empty() && !stepsAccurately(w, batch);
  constexpr std::size_t kBodies = BodyBlock::kLanes;
  batch.lanes.resize(isAlone ? (batch.slots.size() + kBodies - 1) / kBodies : 0);
  takeResponses(batch);
  groupContacts(w, batch, levels);
  const auto contactsOf = [&](int group) {
    const int first = group > 0 ? groupEnd[group - 1] : 0;
    return std::span(inGroup).subspan(first, groupEnd[group] - first);
  };
  const auto listOf = [](const Place& place) {
    return (place.group * kColours + place.colour) * kSorts + place.sort;
  };
  colours.assign(order.stages() * batch.slots.size(), 0);
  groupColours.assign(order.count(), 0);
  firstOf.assign(static_cast<std::size_t>(order.count()) * kColours * kSorts, 0);
  forEachPlanned(w, levels, [&](int group) {
    for (const int i : contactsOf(group)) {
      Place& place = places[i];
      place.colour = colourOf(place, &colours[place.stage * batch.slots.size()]);
      groupColours[group] |= std::uint64_t{1} << place.colour;
      ++firstOf[listOf(place)];
    }
  });
  batch.blocks.resize(countLanes(batch, levels) / kLanes);
  forEachGroup(w, batch, [&](int from, int to) {
    for (int k = from; k < to; ++k) {
      std::fill(std::begin(batch.blocks[k].contact), std::end(batch.blocks[k].contact), -1);
      batch.blocks[k].points = 1;
    }
  });
  forEachPlanned(w, levels, [&](int group) {
    for (const int i : contactsOf(group)) {
      int& lane = firstOf[listOf(places[i])];
      const int list = group * kColours + places[i].colour;
      ContactBlock& block = batch.blocks[lane / kLanes];
      block.contact[lane % kLanes] = batch.contacts[i];
      block.points = std::max(block.points, places[i].points);
      block.colour = laneStride(list) == 1 ? list : -1;
      lane += laneStride(list);
    }
  });
  forEachGroup(w, batch, [&](int from, int to) {
    for (int k = from; k < to; ++k) {
      for (int l = 0; l < kLanes; ++l) takeSlots(w.bodies, batch.blocks[k], l);
    }
  });
}

}  // namespace physics
