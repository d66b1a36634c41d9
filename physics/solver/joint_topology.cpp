// The order of elimination.
#include "physics/solver/joint_topology.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <map>

namespace physics {
namespace {

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
  shape.hasWay = kind.hasLinear || kind.seen == JointSeen::kGap;
  shape.isGap = kind.seen == JointSeen::kGap;
  shape.hasLinear = kind.hasLinear;
  shape.hasAngular = kind.hasAngular;
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

bool isLimit(const JointShape& shape) {
  return shape.seen == JointSeen::kCone || shape.seen == JointSeen::kTwist;
}

std::vector<int> eliminationOrder(const std::vector<JointShape>& shapes, const Meetings& at) {
  std::vector<int> inner, place(shapes.size(), -1), limits;
  for (int i = 0; i < static_cast<int>(shapes.size()); ++i) {
    if (isLimit(shapes[i])) {
      limits.push_back(i);
      continue;
    }
    place[i] = static_cast<int>(inner.size());
    inner.push_back(i);
  }
  const int rows = static_cast<int>(inner.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < rows; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& list : at) {
    for (const auto& [i, bi] : list) {
      for (const auto& [j, bj] : list) {
        if (i != j && place[i] >= 0 && place[j] >= 0) entries.emplace_back(place[i], place[j], 1.0);
      }
    }
  }
  Eigen::SparseMatrix<double> pattern(rows, rows);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  if (rows > 0) Eigen::AMDOrdering<int>()(pattern, order);
  std::vector<int> result;
  for (int k = 0; k < rows; ++k) result.push_back(inner[order.indices()[k]]);
  result.insert(result.end(), limits.begin(), limits.end());
  return result;
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
    for (const int k : below) t.below.push_back({k, blocks.of.at({k, i})});
    for (std::size_t q = 0; q < below.size(); ++q) {
      for (std::size_t p = 0; p <= q; ++p) {
        const bool isBlock = p != q && below[p] < t.tailStart;
        t.updates.push_back(isBlock ? blocks.need(below[q], below[p]) : -1);
      }
    }
    t.columns.push_back(column);
  }
  t.meetings.resize(blocks.of.size());
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
  t->order = eliminationOrder(shapes, meetingsOf(shapes, t->bodyCount));
  for (const int i : t->order) {
    if (shapes[i].seen == JointSeen::kByKind)
      t->others.push_back(static_cast<int>(t->shapes.size()));
    t->shapes.push_back(shapes[i]);
    if (!isLimit(shapes[i])) t->tailStart = static_cast<int>(t->shapes.size());
  }
  Blocks blocks;
  blocks.below.resize(refs.size());
  couple(*t, meetingsOf(t->shapes, t->bodyCount), blocks);
  fill(*t, blocks);
  known.push_back(t);
  return t;
}

}  // namespace physics
