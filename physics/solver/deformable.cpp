// Cloth and soft bodies, swept.
#include "physics/solver/deformable.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "physics/base/rotation.h"

namespace physics {

using namespace swept;

Mesh meshOf(const std::vector<JointRef>& refs, const Kinds& kinds,
            std::span<const InverseMass> masses) {
  Mesh mesh;
  std::map<BodyId, int> place;
  std::vector<std::array<BodyId, 2>> joined;
  int kindPlace = 0;
  forEachKind(kinds, [&](const auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    for (const JointRef& ref : refs) {
      if (ref.kind != kindPlace) continue;
      const auto& bodies = kind.set.items[ref.item].bodies;
      mesh.points = mesh.points || (C::kBodies != 1 && !isAngular<C>());
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (masses[bodies[i]].m > 0) place.insert({bodies[i], 0});
        for (std::size_t j = i + 1; j < bodies.size(); ++j) {
          if (C::kBodies == kMany && j > i + 1) break;  // a row of its own, eliminated last
          if (masses[bodies[i]].m > 0 && masses[bodies[j]].m > 0) {
            joined.push_back({bodies[i], bodies[j]});
          }
        }
      }
    }
    ++kindPlace;
  });
  int count = 0;
  for (auto& [body, index] : place) index = count++;
  std::vector<std::array<int, 2>> entries;
  for (int i = 0; i < count; ++i) entries.push_back({i, i});
  for (const auto& [a, b] : joined) {
    entries.push_back({std::max(place[a], place[b]), std::min(place[a], place[b])});
  }
  SparsePattern pattern;
  pattern.layOut(entries);
  mesh.fill = pattern.fill();
  return mesh;
}

namespace {

// A of a total length as that of its pieces, one after the other: its own comes to nothing where
// they are in line.
double ownOfPieces(const RopeLength& item, std::span<const JointMass> masses) {
  double sum = 0;
  for (std::size_t p = 1; p < item.bodies.size(); ++p) {
    sum += masses[item.bodies[p - 1]].inverse + masses[item.bodies[p]].inverse;
  }
  return sum;
}

}  // namespace

Deformable::Deformable(const std::vector<JointRef>& refs, const Kinds& kinds,
                       std::span<const InverseMass> masses, bool direct) {
  int place = 0;
  size_ = refs.size();
  forEachKind(kinds, [&](const auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    for (const JointRef& ref : refs) {
      if (ref.kind != place) continue;
      std::get<std::vector<SweptRow<C>>>(rows_).emplace_back().item = ref.item;
      const auto& bodies = kind.set.items[ref.item].bodies;
      for (const BodyId body : bodies) {
        if (masses[body].m > 0) bodies_.push_back(body);
      }
      if constexpr (std::is_same_v<C, Link> || std::is_same_v<C, RopeLength>) {
        for (std::size_t p = 1; p < bodies.size(); ++p) {
          pieces_.push_back({bodies[p - 1], bodies[p]});
        }
      }
    }
    ++place;
  });
  std::sort(bodies_.begin(), bodies_.end());
  bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
  solved_ = bodies_;
  if (direct) {
    findImplied(kinds);
    factor_ = std::make_unique<MeshFactor>();
  } else {
    choosePoints(kinds, masses);
  }
}

// A total length that rigid links along it add up to is held by them: no row of a cloth's. Of a
// rope's it stays one that repeats others: Newton's method finds sooner which links are slack.
// Links that are swept say little of how long all of them are.
void Deformable::findImplied(const Kinds& kinds) {
  std::map<std::array<int, 2>, double> lengths;
  const auto keyOf = [&](BodyId a, BodyId b) {
    return std::array<int, 2>{std::min(a, b), std::max(a, b)};
  };
  forEachRow(rows_, kinds, [&]<class C>(const C& item, SweptRow<C>&, double) {
    if constexpr (std::is_same_v<C, Link>) {
      if (item.compliance == 0) lengths[keyOf(item.bodies[0], item.bodies[1])] = item.length;
    }
  });
  forEachRow(rows_, kinds, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (std::is_same_v<C, RopeLength>) {
      double sum = 0;
      for (std::size_t p = 1; p < item.bodies.size(); ++p) {
        const auto found = lengths.find(keyOf(item.bodies[p - 1], item.bodies[p]));
        sum += found == lengths.end() ? kUnbounded : found->second;
      }
      swept.isImplied = item.rope && sum <= (1 + kRedundancy) * item.length;
    }
  });
}

void Deformable::evaluate(const JointStage& stage, bool first) {
  for (const BodyId i : bodies_) {
    displace(stage.pose[i], stage.moved[i].u, stage.moved[i].theta);
  }
  evaluateRows(stage, first);
  for (const BodyId i : bodies_) stage.pose[i] = stage.start[i];
}

void Deformable::evaluateRows(const JointStage& stage, bool first) {
  const Kinds& kinds = stage.kinds;
  const Configuration at = {stage.pose, stage.start, stage.h};
  const auto masses = stage.masses;
  const auto moved = stage.moved;
  const double longer = first && before_ > 0 ? stage.h / before_ : 1;
  before_ = stage.h;
  const auto prepare = [&]<class C>(const C& item, SweptRow<C>& swept, double regularisation) {
    item.evaluate(at, swept.row);
    swept.pulled = longer * longer * swept.lambda;
    if (first) swept.lambda.setZero();
    swept.next = swept.lambda;
    swept.swept = false;
    if (!swept.row.active || (points_ && swept.isImplied)) return;
    swept.constant = errorOf<C>(swept);
    invert<C>(swept, respond(item, swept, masses), Force<C> ? 0 : regularisation);
    if constexpr (std::is_same_v<C, RopeLength>) {
      if (!swept.isImplied) swept.own = ownOfPieces(item, masses);
    }
    if (swept.isLoad) {
      swept.swept = false;
    } else {
      swept.constant -= along(item, swept, moved);
    }
  };
  const auto load = [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if (!swept.row.active || !swept.isLoad) return;
    swept.lambda = clamped<C>(swept, swept.constant);
    give(item, swept, swept.lambda, moved);
  };
  kinds_ = &kinds;
  if (factor_) takeMasses(masses);
  forEachRow(rows_, kinds, prepare);
  if (first) forEachRow(rows_, kinds, load);
  if (points_) takeStiffness(masses, first);
}

void Deformable::solvePositions(const JointStage& stage, double step, double push,
                                std::span<SoftRow> rows) {
  const double substeps = step / stage.h;
  gives_ = kGivesInStep * substeps * substeps;
  if (!factor_ && !points_) return evaluate(stage, true);
  takeContacts(rows, push);
  if (factor_) return solveAllPositions(stage);
  takePressed();
  solvePointPositions(stage);
}

void Deformable::sweepPositions(const JointStage& stage) {
  if (factor_) return;
  bool any = false;
  forEachRow(rows_, *kinds_, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if (!swept.swept || swept.isAtOnce) return;
    any = true;
    change(item, swept,
           typename Set<C>::Vector(swept.constant + along(item, swept, stage.moved) +
                                   swept.alpha * swept.lambda),
           stage.moved);
  });
  if (points_ && any) solvePoints(true, false, stage.masses, stage.moved);
}

void Deformable::prepareVelocities(const Kinds& kinds, const Configuration& at,
                                   std::span<const JointMass> masses,
                                   std::span<const Displacement> moved) {
  if (factor_) takeMasses(masses);
  if (points_) preparePointVelocities(moved);
  forEachRow(rows_, kinds, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if (swept.isAtOnce) return;  // as they are
    swept.swept = swept.swept && !givesWay(swept) && !isSlack(swept);
    if (!swept.swept) return;
    item.evaluate(at, swept.row);
    swept.swept = swept.row.active;
    if (swept.swept) invert<C>(swept, respond(item, swept, masses), 0);
  });
}

void Deformable::sweepVelocities(std::span<const JointMass> masses, std::span<Displacement> moved) {
  if (factor_) return solveVelocities(moved);
  if (points_) solvePoints(false, false, masses, moved);
  bool any = false;
  forEachRow(rows_, *kinds_, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if (!swept.swept || swept.isAtOnce) return;
    any = true;
    change(item, swept, along(item, swept, moved), moved);
  });
  if (points_ && any) solvePoints(false, false, masses, moved);
}

double Deformable::strain(const Kinds& kinds, const Configuration& at) {
  double sum = 0, load = 0;
  forEachRow(rows_, kinds, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (!Force<C> && C::kLinear) {
      if (!swept.row.active || !swept.alpha.isZero(0) || swept.lambda.isZero(0)) return;
      double extent = 0;
      for (const BodyId i : item.bodies) {
        extent = std::max(extent, (at.now[i].x - at.now[item.bodies[0]].x).norm());
      }
      if (!(extent > 0)) return;
      item.evaluate(at, swept.row);
      const double size = swept.row.linear[0].norm(), off = swept.row.c.norm() / extent;
      if (!(size > 0)) return;
      sum += swept.lambda.norm() * off * off / size;
      load += swept.lambda.norm() * size;
    }
  });
  return load > 0 ? std::sqrt(sum / load) : 0;
}

double Deformable::turn(const Configuration& at) const {
  double most = 0;
  for (const auto& [a, b] : pieces_) {
    const Vec3 now = at.now[b].x - at.now[a].x, start = at.start[b].x - at.start[a].x;
    most = std::max(most, arcTangent(start.cross(now).norm(), start.dot(now)));
  }
  return most;
}

void Deformable::goOn(const Kinds& kinds) {
  forEachKind(kinds, [&](const auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    for (SweptRow<C>& swept : std::get<std::vector<SweptRow<C>>>(rows_)) {
      swept.lambda = kind.set.lambda[swept.item].total;
      before_ = kind.set.lambda[swept.item].step;
    }
  });
}

void Deformable::finish(Kinds& kinds, double dt) const {
  forEachKind(kinds, [&](auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    for (const SweptRow<C>& swept : std::get<std::vector<SweptRow<C>>>(rows_)) {
      kind.set.lambda[swept.item].total = swept.lambda;
      kind.set.lambda[swept.item].step = dt;
    }
  });
}

}  // namespace physics
