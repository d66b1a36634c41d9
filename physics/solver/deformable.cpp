// Cloth and soft bodies, swept.
#include "physics/solver/deformable.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "physics/base/rotation.h"

namespace physics {

using namespace swept;

Mesh meshOf(const SweptRows& rows, std::span<const InverseMass> masses) {
  Mesh mesh;
  std::map<BodyId, int> place;
  std::vector<std::array<BodyId, 2>> joined;
  forEachRow(rows, [&](const SweptItem& swept) {
    const std::vector<BodyId>& bodies = swept.bodies;
    mesh.points = mesh.points || (bodies.size() != 1 && !swept.turns);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (masses[bodies[i]].m > 0) place.insert({bodies[i], 0});
      for (std::size_t j = i + 1; j < bodies.size(); ++j) {
        if (swept.isLength && j > i + 1) break;  // a row of its own, eliminated last
        if (masses[bodies[i]].m > 0 && masses[bodies[j]].m > 0) {
          joined.push_back({bodies[i], bodies[j]});
        }
      }
    }
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
double ownOfPieces(const SweptItem& swept, std::span<const JointMass> masses) {
  double sum = 0;
  for (std::size_t p = 1; p < swept.bodies.size(); ++p) {
    sum += masses[swept.bodies[p - 1]].inverse + masses[swept.bodies[p]].inverse;
  }
  return sum;
}

}  // namespace

Deformable::Deformable(SweptRows rows, const Kinds& kinds, std::span<const InverseMass> masses,
                       bool direct)
    : rows_(std::move(rows)) {
  forEachRow(rows_, [&](const SweptItem& swept) {
    ++size_;
    for (const BodyId body : swept.bodies) {
      if (masses[body].m > 0) bodies_.push_back(body);
    }
    for (std::size_t p = 1; swept.isOfPieces() && p < swept.bodies.size(); ++p) {
      pieces_.push_back({swept.bodies[p - 1], swept.bodies[p]});
    }
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
  forEachRow(rows_, [&](const SweptItem& swept) {
    if (!swept.isLink) return;
    const Link& item = std::get<Kind<LinkDef, Link>>(kinds).set.items[swept.ref.item];
    if (item.compliance == 0) lengths[keyOf(swept.bodies[0], swept.bodies[1])] = item.length;
  });
  forEachRow(rows_, [&](SweptItem& swept) {
    if (!swept.isLength) return;
    double sum = 0;
    for (std::size_t p = 1; p < swept.bodies.size(); ++p) {
      const auto found = lengths.find(keyOf(swept.bodies[p - 1], swept.bodies[p]));
      sum += found == lengths.end() ? kUnbounded : found->second;
    }
    const auto& item = std::get<Kind<RopeLengthDef, RopeLength>>(kinds).set.items[swept.ref.item];
    swept.isImplied = item.rope && sum <= (1 + kRedundancy) * item.length;
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
  const Configuration at = {stage.pose, stage.start, stage.h};
  const auto masses = stage.masses;
  const auto moved = stage.moved;
  const double longer = first && before_ > 0 ? stage.h / before_ : 1;
  before_ = stage.h;
  const auto prepare = [&]<int kRows>(SweptRow<kRows>& swept) {
    swept::evaluate(stage.kinds, at, Seen::kAll, many_, swept);
    swept.pulled = longer * longer * swept.lambda;
    if (first) swept.lambda.setZero();
    swept.next = swept.lambda;
    swept.swept = false;
    if (!swept.active || (points_ && swept.isImplied)) return;
    invert(swept, respond(swept, masses), swept.regularisation);
    if (swept.isLength && !swept.isImplied) swept.own = ownOfPieces(swept, masses);
    if (swept.isLoad) {
      swept.swept = false;
    } else {
      swept.constant -= along(swept, moved);
    }
  };
  const auto load = [&]<int kRows>(SweptRow<kRows>& swept) {
    if (!swept.active || !swept.isLoad) return;
    swept.lambda = clamped(swept, swept.constant);
    give(swept, swept.lambda, moved);
  };
  if (factor_) takeMasses(masses);
  forEachRow(rows_, prepare);
  if (first) forEachRow(rows_, load);
  if (points_) takeStiffness(masses, first);
}

void Deformable::solvePositions(const JointStage& stage, double step, double push, double closed,
                                std::span<SoftRow> rows) {
  const double substeps = step / stage.h;
  gives_ = kGivesInStep * substeps * substeps;
  if (!factor_ && !points_) return evaluate(stage, true);
  takeContacts(rows, push);
  if (factor_) return solveAllPositions(stage);
  takePressed();
  solvePointPositions(stage, closed);
}

void Deformable::sweepPositions(const JointStage& stage) {
  if (factor_) return;
  bool any = false;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (!swept.swept || swept.isAtOnce) return;
    any = true;
    change(swept,
           typename SweptRow<kRows>::Vector(swept.constant + along(swept, stage.moved) +
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
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (swept.isAtOnce) return;  // as they are
    swept.swept = swept.swept && !givesWay(swept) && !isSlack(swept);
    if (!swept.swept) return;
    swept::evaluate(kinds, at, Seen::kGradients, many_, swept);
    swept.swept = swept.active;
    if (swept.swept) invert(swept, respond(swept, masses), 0);
  });
}

void Deformable::sweepVelocities(std::span<const JointMass> masses, std::span<Displacement> moved) {
  if (factor_) return solveVelocities(moved);
  if (points_) solvePoints(false, false, masses, moved);
  bool any = false;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (!swept.swept || swept.isAtOnce) return;
    any = true;
    change(swept, along(swept, moved), moved);
  });
  if (points_ && any) solvePoints(false, false, masses, moved);
}

double Deformable::strain(const Kinds& kinds, const Configuration& at) {
  double sum = 0, load = 0;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (swept.isForce || !swept.moves || !swept.active) return;
    if (!swept.alpha.isZero(0) || swept.lambda.isZero(0)) return;
    double extent = 0;
    for (const BodyId i : swept.bodies) {
      extent = std::max(extent, (at.now[i].x - at.now[swept.bodies[0]].x).norm());
    }
    if (!(extent > 0)) return;
    swept::evaluate(kinds, at, Seen::kGradients, many_, swept);
    const double size = swept.linear[0].j.norm(), off = swept.c.norm() / extent;
    if (!(size > 0)) return;
    sum += swept.lambda.norm() * off * off / size;
    load += swept.lambda.norm() * size;
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
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    const Multiplier last = readMultiplier(kinds, swept.ref);
    swept.lambda = last.total.template head<kRows>();
    before_ = last.dt;
  });
}

void Deformable::keep() {
  forEachRow(rows_, [](auto& swept) { swept.kept = swept.lambda; });
  beforeKept_ = before_;
}

void Deformable::goBack() {
  forEachRow(rows_, [](auto& swept) { swept.lambda = swept.kept; });
  before_ = beforeKept_;
}

void Deformable::finish(Kinds& kinds, double dt) const {
  forEachRow(rows_, [&]<int kRows>(const SweptRow<kRows>& swept) {
    Vec3 total = Vec3::Zero();
    total.head<kRows>() = swept.lambda;
    writeMultiplier(kinds, swept.ref, total, dt);
  });
}

}  // namespace physics
