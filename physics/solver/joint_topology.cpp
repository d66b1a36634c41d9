// The order of elimination.
#include "physics/solver/joint_topology.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "physics/solver/elimination_order.h"

namespace physics {
namespace {

// How much more work a factor may be with the limits last: with them among the other rows figures
// that lie in a heap were factored 3.8 times a substep, and once with them last.
constexpr double kTailWork = 4;

// Rows at a body that moves, and the body's place in each.
using Meetings = std::vector<std::vector<std::pair<int, int>>>;

JointShape shapeOf(const JointKind& kind, std::span<const BodyId> bodies,
                   std::span<const InverseMass> masses) {
  JointShape shape;
  shape.rows = kind.rows;
  shape.size = kind.rows == 1 ? 1 : 3;
  shape.bodyCount = kind.bodyCount;
  shape.seen = kind.seen;
  shape.pulls = kind.pulls;
  shape.stands = kind.stands;
  shape.hasWay = kind.hasLinear || kind.seen == JointSeen::kGap;
  shape.isGap = kind.seen == JointSeen::kGap;
  shape.hasLinear = kind.hasLinear;
  shape.hasAngular = kind.hasAngular;
  shape.isWay = kind.isForce && kind.hasLinear;
  for (int b = 0; b < kind.bodyCount; ++b) {
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), kind.bodies[b]);
    shape.body[b] = static_cast<int>(found - bodies.begin());
    shape.moves[b] = masses[kind.bodies[b]].m > 0;
  }
  return shape;
}

Meetings meetingsOf(const std::vector<JointShape>& shapes, int bodyCount) {
  Meetings at(bodyCount);
  for (int i = 0; i < static_cast<int>(shapes.size()); ++i) {
    for (int b = 0; b < shapes[i].bodyCount; ++b) {
      if (shapes[i].moves[b]) at[shapes[i].body[b]].push_back({i, b});
    }
  }
  return at;
}

// Of these rows.
std::vector<int> orderOf(const std::vector<int>& rows, const std::vector<JointShape>& shapes,
                         const Meetings& at) {
  std::vector<int> place(shapes.size(), -1), sizes;
  for (const int i : rows) {
    place[i] = static_cast<int>(sizes.size());
    sizes.push_back(shapes[i].size);
  }
  std::vector<std::set<int>> meets(rows.size());
  for (const auto& list : at) {
    for (const auto& [i, bi] : list) {
      for (const auto& [j, bj] : list) {
        if (i != j && place[i] >= 0 && place[j] >= 0) meets[place[i]].insert(place[j]);
      }
    }
  }
  std::vector<int> result;
  for (const int k : EliminationOrder(meets, sizes).find()) result.push_back(rows[k]);
  return result;
}

// What factorizing in this order multiplies; more than `most` is not counted to its end.
double workOf(const std::vector<int>& order, const std::vector<JointShape>& shapes,
              const Meetings& at, double most) {
  std::vector<int> place(shapes.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  std::vector<std::set<int>> below(order.size());
  for (const auto& list : at) {
    for (const auto& [i, bi] : list) {
      for (const auto& [j, bj] : list) {
        if (place[i] > place[j]) below[place[j]].insert(place[i]);
      }
    }
  }
  double work = 0;
  for (std::size_t k = 0; k < order.size() && work <= most; ++k) {
    double height = shapes[order[k]].size;
    for (const int later : below[k]) height += shapes[order[later]].size;
    work += shapes[order[k]].size * height * height;
    if (below[k].empty()) continue;
    const int parent = *below[k].begin();
    below[parent].insert(std::next(below[k].begin()), below[k].end());
  }
  return work;
}

struct Order {
  std::vector<int> rows;
  int tailStart = 0;
};

// Limits last, where a factor is not much more work for that: it is one that no round repeats.
Order eliminationOrder(const std::vector<JointShape>& shapes, const Meetings& at) {
  std::vector<int> all(shapes.size()), inner, limits;
  std::iota(all.begin(), all.end(), 0);
  for (const int i : all) (isLimit(shapes[i]) ? limits : inner).push_back(i);
  Order together{orderOf(all, shapes, at), static_cast<int>(shapes.size())};
  if (limits.empty()) return together;
  Order last{orderOf(inner, shapes, at), static_cast<int>(inner.size())};
  last.rows.insert(last.rows.end(), limits.begin(), limits.end());
  const double most =
      kTailWork * workOf(together.rows, shapes, at, std::numeric_limits<double>::infinity());
  return workOf(last.rows, shapes, at, most) <= most ? last : together;
}

// Blocks below the diagonal as they are met, those of fill after those of rows that share a body.
struct Blocks {
  std::map<std::pair<int, int>, int> of;  // later, earlier
  std::vector<std::vector<int>> below;    // by column
  int need(int later, int earlier) {
    const auto [entry, isNew] = of.insert({{later, earlier}, static_cast<int>(of.size())});
    if (isNew) below[earlier].push_back(later);
    return entry->second;
  }
};

// The place of two rows of the tail in `t.tail`.
JointMeeting& pairOf(JointTopology& t, int later, int earlier) {
  for (JointPair& pair : t.tail) {
    if (pair.later == later && pair.earlier == earlier) return pair.meeting;
  }
  t.tail.push_back({later, earlier, {}});
  return t.tail.back().meeting;
}

JointMeeting& meetingOf(JointTopology& t, Blocks& blocks, int i, int j) {
  if (j >= t.tailStart) return pairOf(t, i - t.tailStart, j - t.tailStart);
  const std::size_t block = blocks.need(i, j);
  if (block >= t.meetings.size()) t.meetings.resize(block + 1);
  return t.meetings[block];
}

void couple(JointTopology& t, const Meetings& at, Blocks& blocks) {
  for (const auto& list : at) {
    for (const auto& [i, bi] : list) {
      for (const auto& [j, bj] : list) {
        if (i <= j) continue;
        JointMeeting& meeting = meetingOf(t, blocks, i, j);
        meeting.later[meeting.count] = bi;
        meeting.earlier[meeting.count++] = bj;
      }
    }
  }
}

void fill(JointTopology& t, Blocks& blocks) {
  for (int i = 0; i < t.tailStart; ++i) {
    std::vector<int>& below = blocks.below[i];
    std::sort(below.begin(), below.end());
    JointColumn column{static_cast<int>(t.below.size()), static_cast<int>(below.size()),
                       static_cast<int>(t.updates.size())};
    for (const int k : below) {
      const int block = blocks.of.at({k, i});
      t.below.push_back({k, block, t.lower});
      t.lower += t.shapes[k].size * t.shapes[i].size;
    }
    for (std::size_t q = 0; q < below.size(); ++q) {
      for (std::size_t p = 0; p <= q; ++p) {
        const bool isBlock = p != q && below[p] < t.tailStart;
        t.updates.push_back(isBlock ? blocks.need(below[q], below[p]) : -1);
      }
    }
    t.columns.push_back(column);
  }
  t.meetings.resize(blocks.of.size());
  std::vector<int> at(t.meetings.size());
  for (const JointBelow& below : t.below) at[below.block] = below.at;
  for (const int block : t.updates) t.updatesAt.push_back(block < 0 ? block : at[block]);
}

std::vector<int> signatureOf(std::span<const JointRef> refs,
                             const std::vector<JointShape>& shapes) {
  std::vector<int> signature;
  for (std::size_t i = 0; i < refs.size(); ++i) {
    signature.push_back(refs[i].kind);
    for (int b = 0; b < shapes[i].bodyCount; ++b) {
      signature.push_back(2 * shapes[i].body[b] + shapes[i].moves[b]);
    }
  }
  return signature;
}

// A row says what others say only in a loop, the world being one body, or where one pair has rows
// for all of its freedoms.
bool isTreeOf(const std::vector<JointShape>& shapes, int bodyCount) {
  constexpr int kFreedoms = 6;
  std::map<std::pair<int, int>, int> rows;
  for (const JointShape& shape : shapes) {
    int ends[2] = {bodyCount, bodyCount};
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (shape.moves[b]) ends[b] = shape.body[b];
    }
    rows[std::minmax(ends[0], ends[1])] += shape.rows;
  }
  std::vector<int> root(bodyCount + 1);
  std::iota(root.begin(), root.end(), 0);
  for (const auto& [pair, count] : rows) {
    int a = pair.first, b = pair.second;
    while (root[a] != a) a = root[a];
    while (root[b] != b) b = root[b];
    if (a == b || count >= kFreedoms) return false;
    root[a] = b;
  }
  return true;
}

}  // namespace

std::shared_ptr<const JointTopology> topologyOf(std::span<const JointRef> refs,
                                                std::span<const JointKind> kinds,
                                                std::span<const BodyId> bodies,
                                                std::span<const InverseMass> masses,
                                                JointTopologies& known) {
  std::vector<JointShape> shapes;
  for (const JointKind& kind : kinds) shapes.push_back(shapeOf(kind, bodies, masses));
  const std::vector<int> signature = signatureOf(refs, shapes);
  for (const auto& topology : known) {
    if (topology->signature == signature) return topology;
  }
  auto t = std::make_shared<JointTopology>();
  t->index = static_cast<int>(known.size());
  t->signature = signature;
  t->bodyCount = static_cast<int>(bodies.size());
  for (const BodyId body : bodies) t->moves.push_back(masses[body].m > 0);
  Order order = eliminationOrder(shapes, meetingsOf(shapes, t->bodyCount));
  t->order = std::move(order.rows);
  t->isTree = isTreeOf(shapes, t->bodyCount);
  t->tailStart = order.tailStart;
  for (const int i : t->order) {
    const int place = static_cast<int>(t->shapes.size());
    if (shapes[i].seen == JointSeen::kByKind) t->others.push_back(place);
    if (shapes[i].seen != JointSeen::kGap && place < t->tailStart) t->bounded.push_back(place);
    t->shapes.push_back(shapes[i]);
  }
  Blocks blocks;
  blocks.below.resize(refs.size());
  couple(*t, meetingsOf(t->shapes, t->bodyCount), blocks);
  fill(*t, blocks);
  known.push_back(t);
  return t;
}

}  // namespace physics
