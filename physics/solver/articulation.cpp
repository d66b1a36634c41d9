// Joints and forces as one block.
#include "physics/solver/articulation.h"

#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <map>

namespace physics {
namespace {

// Keeps the factor regular where rows repeat each other (loops): relative to the row's own A.
constexpr double kRedundancy = 1e-7;

constexpr int kMostRounds = 6;  // of finding which rows are at a bound

constexpr double kFree = std::numeric_limits<double>::infinity();

JointRow::Part partOf(const Mat3& m) {
  if (m(0, 0) == 1 && m == Mat3::Identity()) return JointRow::Part::kPlus;
  if (m(0, 0) == -1 && m == -Mat3::Identity()) return JointRow::Part::kMinus;
  return JointRow::Part::kFull;
}

double signOf(JointRow::Part part) { return part == JointRow::Part::kMinus ? -1 : 1; }

bool isUnit(JointRow::Part part) {
  return part == JointRow::Part::kPlus || part == JointRow::Part::kMinus;
}

// Adds J_k M^-1 J_l^T of the body that is k's p-th and l's q-th.
void addCoupling(const JointRow& k, int p, const JointRow& l, int q, Mat3& sum) {
  using Part = JointRow::Part;
  if (isUnit(k.linearPart[p]) && isUnit(l.linearPart[q])) {
    sum.diagonal().array() += signOf(k.linearPart[p]) * signOf(l.linearPart[q]) * l.inverseMass[q];
  } else if (k.linearPart[p] != Part::kNone && l.linearPart[q] != Part::kNone) {
    sum.noalias() += k.linear[p].lazyProduct(l.responseLinear[q]);
  }
  if (k.angularPart[p] != Part::kNone && l.angularPart[q] != Part::kNone) {
    sum.noalias() += k.angular[p].lazyProduct(l.responseAngular[q]);
  }
}

template <class C>
void takeGradients(const C& item, const Evaluated<C>& row, const Configuration& at,
                   JointRow& joint) {
  constexpr int kRows = C::kRows;
  for (int b = 0; b < C::kBodies; ++b) {
    joint.linear[b].setZero();
    joint.angular[b].setZero();
    joint.linearPart[b] = joint.angularPart[b] = JointRow::Part::kNone;
    if constexpr (C::kLinear) {
      joint.linear[b].template topRows<kRows>() = row.linear[b];
      joint.linearPart[b] = partOf(joint.linear[b]);
    }
    if constexpr (isAngular<C>()) {
      joint.angular[b].template topRows<kRows>() = row.angular[b];
      joint.angularPart[b] = JointRow::Part::kFull;
    }
    if constexpr (requires { item.anchors; }) {
      joint.arm[b] = at.now[item.bodies[b]].q * item.anchors[b];
      joint.pulls = true;
    }
  }
}

// J u + K^-1 lambda = K^-1 f; what does not fall off at all is a load.
template <class C>
void takeForce(const Evaluated<C>& push, JointRow& joint) {
  constexpr int kRows = C::kRows;
  const double mean = push.k.trace() / kRows;
  joint.longest = push.longest;
  if (!(mean > 0)) {
    joint.role = JointRow::Role::kLoad;
    joint.c.template head<kRows>() = push.f;
    return;
  }
  joint.role = JointRow::Role::kForce;
  Eigen::Matrix<double, kRows, kRows> k = 0.5 * (push.k + push.k.transpose());
  k.diagonal().array() += kRedundancy * mean;
  const Eigen::Matrix<double, kRows, kRows> compliance = k.inverse();
  joint.alpha.template topLeftCorner<kRows, kRows>() = compliance;
  joint.c.template head<kRows>() = -(compliance * push.f);
}

template <class C>
void evaluateItem(const C& item, const Configuration& at, JointRow& joint) {
  if constexpr (C::kBodies != kMany) {
    constexpr int kRows = C::kRows;
    Evaluated<C> row;
    item.evaluate(at, row);
    joint.active = row.active;
    joint.alpha.setZero();
    joint.c.setZero();
    joint.low = -kFree;
    joint.high = kFree;
    joint.longest = kFree;
    if (!row.active) return;
    takeGradients(item, row, at, joint);
    if constexpr (Force<C>) {
      takeForce<C>(row, joint);
    } else {
      joint.role = JointRow::Role::kConstraint;
      joint.c.template head<kRows>() = row.c;
      joint.alpha.template topLeftCorner<kRows, kRows>() =
          row.alpha * Eigen::Matrix<double, kRows, kRows>::Identity();
      joint.low = row.low;
      joint.high = row.high;
      joint.longest = row.longest;
    }
  }
}

using Evaluate = void (*)(const Kinds&, const Configuration&, JointRow&);

template <std::size_t... I>
constexpr auto evaluators(std::index_sequence<I...>) {
  return std::array<Evaluate, sizeof...(I)>{
      [](const Kinds& kinds, const Configuration& at, JointRow& row) {
        evaluateItem(std::get<I>(kinds).set.items[row.item], at, row);
      }...};
}
constexpr std::size_t kKinds = std::tuple_size_v<Kinds>;
constexpr auto kEvaluate = evaluators(std::make_index_sequence<kKinds>{});

// f(kind) of the kind with that place in the table.
template <class K, class F>
void withKind(K& kinds, int index, F&& f) {
  int place = 0;
  forEachKind(kinds, [&](auto& kind) {
    if (place++ == index) f(kind);
  });
}

bool isBounded(const JointRow& row) {
  return row.low > -kFree || row.high < kFree || row.longest < kFree;
}

bool givesWay(const JointRow& row) {
  return row.role != JointRow::Role::kConstraint || !row.alpha.isZero(0) || row.regularisation > 0;
}

Vec3 clamped(const JointRow& row, const Vec3& total) {
  Vec3 inside = total;
  for (int r = 0; r < row.rows; ++r) inside[r] = std::clamp(total[r], row.low, row.high);
  const double length = inside.norm();
  if (length > row.longest) inside *= row.longest / length;  // (132)
  return inside;
}

}  // namespace

void evaluateRow(const Kinds& kinds, const Configuration& at, JointRow& row) {
  kEvaluate[row.kind](kinds, at, row);
}

Articulation::Articulation(const std::vector<Ref>& refs, const Kinds& kinds,
                           std::span<const InverseMass> masses) {
  const int n = static_cast<int>(refs.size());
  std::vector<JointRow> rows(refs.size());
  std::map<BodyId, std::vector<std::pair<int, int>>> at;  // row, its place for the body
  for (int i = 0; i < n; ++i) {
    JointRow& row = rows[i];
    row.kind = refs[i].kind;
    row.item = refs[i].item;
    withKind(kinds, row.kind, [&](const auto& kind) {
      using C = typename std::decay_t<decltype(kind)>::Item;
      if constexpr (C::kBodies != kMany) {
        row.rows = C::kRows;
        row.regularisation = Force<C> ? 0 : kind.set.tuned[row.item].regularisation;
        for (const BodyId body : kind.set.items[row.item].bodies) {
          if (masses[body].m > 0) at[body].push_back({i, row.bodyCount});
          row.bodies[row.bodyCount++] = body;
        }
      }
    });
  }
  // Rows meet where they share a body that moves.
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [body, list] : at) {
    bodies_.push_back(body);
    for (const auto& [i, bi] : list) {
      for (const auto& [j, bj] : list) {
        if (i != j) entries.emplace_back(i, j, 1.0);
      }
    }
  }
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  std::vector<int> place(refs.size());  // of a row, in the order of elimination
  rows_.resize(refs.size());
  for (int k = 0; k < n; ++k) {
    place[order.indices()[k]] = k;
    rows_[k] = rows[order.indices()[k]];
  }
  std::map<std::pair<int, int>, int> blockOf;  // later, earlier
  std::vector<std::vector<int>> below(refs.size());
  const auto need = [&](int later, int earlier) {
    const auto [entry, isNew] =
        blockOf.insert({{later, earlier}, static_cast<int>(blockOf.size())});
    if (isNew) below[earlier].push_back(later);
    return entry->second;
  };
  for (const auto& [body, list] : at) {
    for (const auto& [i, bi] : list) {
      for (const auto& [j, bj] : list) {
        if (place[i] > place[j]) {
          couplings_.push_back({need(place[i], place[j]), place[i], bi, place[j], bj});
        }
      }
    }
  }
  columns_.resize(refs.size());
  for (int i = 0; i < n; ++i) {
    std::sort(below[i].begin(), below[i].end());
    Column& column = columns_[i];
    for (const int k : below[i]) {
      column.to.push_back(k);
      column.block.push_back(blockOf[{k, i}]);
    }
    const int m = static_cast<int>(below[i].size());
    for (int p = 0; p < m; ++p) {
      for (int q = p; q < m; ++q) {
        column.update.push_back({q, p, q == p ? -1 : need(below[i][q], below[i][p])});
      }
    }
  }
  blocks_.resize(blockOf.size());
  scaled_.resize(blockOf.size());
  diagonal_.resize(refs.size());
  inverse_.resize(refs.size());
  right_.resize(refs.size());
}

void Articulation::stiffen(std::span<const Pose>, std::span<Mat3> stiffness) const {
  for (const JointRow& row : rows_) {
    if (!row.pulls || !row.active) continue;
    for (int b = 0; b < row.bodyCount; ++b) {
      const Vec3 force = row.linear[b].transpose() * row.lambda;
      const double along = force.dot(row.arm[b]), length2 = row.arm[b].squaredNorm();
      if (!(along > 0)) continue;
      stiffness[row.bodies[b]] +=
          along * (Mat3::Identity() - row.arm[b] * row.arm[b].transpose() / length2);
    }
  }
}

// `all`: also those that are held, which say whether they are free.
void Articulation::evaluate(Kinds& kinds, const Configuration& at, bool all) {
  for (JointRow& row : rows_) {
    if (all || row.free) evaluateRow(kinds, at, row);
  }
}

void Articulation::respond(JointRow& row, std::span<const JointMass> masses) {
  for (int b = 0; b < row.bodyCount; ++b) {
    const JointMass& mass = masses[row.bodies[b]];
    row.inverseMass[b] = mass.inverse;
    if (row.linearPart[b] == JointRow::Part::kFull) {
      row.responseLinear[b] = mass.inverse * row.linear[b].transpose();
    }
    if (row.angularPart[b] != JointRow::Part::kNone) {
      row.responseAngular[b].noalias() = mass.inertia.lazyProduct(row.angular[b].transpose());
    }
  }
}

void Articulation::lay(Pattern& pattern) const {
  const std::size_t n = rows_.size();
  pattern.free.resize(n);
  for (std::size_t i = 0; i < n; ++i) pattern.free[i] = rows_[i].free;
  pattern.rows.clear();
  pattern.start.clear();
  pattern.below.clear();
  pattern.updateStart.clear();
  pattern.update.clear();
  pattern.couplings.clear();
  pattern.blocks.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (!rows_[i].free) continue;
    const Column& column = columns_[i];
    pattern.rows.push_back(static_cast<int>(i));
    pattern.start.push_back(static_cast<int>(pattern.below.size()));
    pattern.updateStart.push_back(static_cast<int>(pattern.update.size()));
    for (std::size_t k = 0; k < column.to.size(); ++k) {
      if (!rows_[column.to[k]].free) continue;
      pattern.below.push_back({column.to[k], column.block[k]});
      pattern.blocks.push_back(column.block[k]);
    }
    for (const auto& [q, p, target] : column.update) {
      if (!rows_[column.to[q]].free || !rows_[column.to[p]].free) continue;
      pattern.update.push_back(
          {column.block[q], column.block[p], target < 0 ? -1 - column.to[q] : target});
    }
  }
  pattern.start.push_back(static_cast<int>(pattern.below.size()));
  pattern.updateStart.push_back(static_cast<int>(pattern.update.size()));
  for (const Coupling& c : couplings_) {
    if (rows_[c.later].free && rows_[c.earlier].free) pattern.couplings.push_back(c);
  }
}

const Articulation::Pattern& Articulation::pattern() {
  for (const Pattern& known : patterns_) {
    bool same = known.free.size() == rows_.size();
    for (std::size_t i = 0; same && i < rows_.size(); ++i) same = known.free[i] == rows_[i].free;
    if (same) return known;
  }
  Pattern& oldest = patterns_[nextPattern_];
  nextPattern_ = (nextPattern_ + 1) % static_cast<int>(patterns_.size());
  lay(oldest);
  return oldest;
}

void Articulation::factorize(std::span<const JointMass> masses) {
  stale_ = false;
  const Pattern& pattern = this->pattern();
  now_ = &pattern;
  for (const int block : pattern.blocks) blocks_[block].setZero();
  for (const int i : pattern.rows) {
    JointRow& row = rows_[i];
    respond(row, masses);
    Mat3 a = Mat3::Zero();
    for (int b = 0; b < row.bodyCount; ++b) addCoupling(row, b, row, b, a);
    const double mean = a.trace() / row.rows;
    row.yields = row.regularisation * mean;
    a += row.alpha;
    a.diagonal().array() += row.yields;
    a.diagonal().array() += mean > 0 ? kRedundancy * mean : 1;  // 1: nothing here can move
    for (int r = row.rows; r < 3; ++r) a(r, r) = 1;
    diagonal_[i] = a;
  }
  for (const Coupling& c : pattern.couplings) {
    addCoupling(rows_[c.later], c.laterBody, rows_[c.earlier], c.earlierBody, blocks_[c.block]);
  }
  for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
    const int i = pattern.rows[k];
    inverse_[i] = diagonal_[i].inverse();
    for (int j = pattern.start[k]; j < pattern.start[k + 1]; ++j) {
      const int block = pattern.below[j][1];
      scaled_[block].noalias() = blocks_[block].lazyProduct(inverse_[i]);
    }
    for (int j = pattern.updateStart[k]; j < pattern.updateStart[k + 1]; ++j) {
      const auto& [scaled, block, target] = pattern.update[j];
      (target < 0 ? diagonal_[-1 - target] : blocks_[target]).noalias() -=
          scaled_[scaled].lazyProduct(blocks_[block].transpose());
    }
  }
}

void Articulation::substitute() {
  const Pattern& pattern = *now_;
  const std::size_t n = pattern.rows.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 y = right_[pattern.rows[k]];
    for (int j = pattern.start[k]; j < pattern.start[k + 1]; ++j) {
      right_[pattern.below[j][0]].noalias() -= scaled_[pattern.below[j][1]].lazyProduct(y);
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    const int i = pattern.rows[k];
    Vec3 y = inverse_[i].lazyProduct(right_[i]);
    for (int j = pattern.start[k]; j < pattern.start[k + 1]; ++j) {
      y.noalias() -=
          scaled_[pattern.below[j][1]].transpose().lazyProduct(right_[pattern.below[j][0]]);
    }
    right_[i] = y;
  }
}

Vec3 Articulation::along(const JointRow& row, std::span<const Displacement> moved) const {
  Vec3 sum = Vec3::Zero();
  for (int b = 0; b < row.bodyCount; ++b) {
    const Displacement& m = moved[row.bodies[b]];
    if (isUnit(row.linearPart[b])) {
      sum += signOf(row.linearPart[b]) * m.u;
    } else if (row.linearPart[b] != JointRow::Part::kNone) {
      sum.noalias() += row.linear[b].lazyProduct(m.u);
    }
    if (row.angularPart[b] != JointRow::Part::kNone) {
      sum.noalias() += row.angular[b].lazyProduct(m.theta);
    }
  }
  return sum;
}

void Articulation::give(const JointRow& row, const Vec3& change,
                        std::span<Displacement> moved) const {
  for (int b = 0; b < row.bodyCount; ++b) {
    Displacement& m = moved[row.bodies[b]];
    if (isUnit(row.linearPart[b])) {
      m.u += (signOf(row.linearPart[b]) * row.inverseMass[b]) * change;
    } else if (row.linearPart[b] != JointRow::Part::kNone) {
      m.u.noalias() += row.responseLinear[b].lazyProduct(change);
    }
    if (row.angularPart[b] != JointRow::Part::kNone) {
      m.theta.noalias() += row.responseAngular[b].lazyProduct(change);
    }
  }
}

void Articulation::apply(std::span<Displacement> moved) {
  for (const int i : now_->rows) {
    JointRow& row = rows_[i];
    row.lambda += right_[i];
    give(row, right_[i], moved);
  }
}

// Rows that the solution would take past a bound are held there, and the others are to be solved
// for again: what one row gives up, the rows around it have not counted on.
bool Articulation::holdAtBounds(std::span<Displacement> moved) {
  bool any = false;
  for (const int i : now_->rows) {
    JointRow& row = rows_[i];
    if (!isBounded(row)) continue;
    const Vec3 wanted = row.lambda + right_[i], inside = clamped(row, wanted);
    if (inside == wanted) continue;
    if (inside != row.lambda) give(row, inside - row.lambda, moved);
    row.lambda = inside;
    row.free = false;
    any = true;
  }
  stale_ = stale_ || any;
  return any;
}

// What of the errors at X^t a substep leaves to later ones, where they are taken back no faster
// than `most` [m, rad] at a time.
void Articulation::leave(Kinds& kinds, const Configuration& at, double most) {
  evaluate(kinds, {at.start, at.start, at.dt}, true);
  for (JointRow& row : rows_) {
    const double error = row.c.norm();
    row.left.setZero();
    if (row.role == JointRow::Role::kConstraint && error > most) {
      row.left = (1 - most / error) * row.c;
    }
  }
}

void Articulation::begin(std::span<const JointMass> masses, std::span<Displacement> moved) {
  for (JointRow& row : rows_) {
    row.lambda.setZero();
    row.free = row.active && row.role != JointRow::Role::kLoad;
    if (row.active && row.role == JointRow::Role::kLoad) {
      respond(row, masses);
      row.lambda = clamped(row, row.c);
      give(row, row.lambda, moved);
    }
  }
  stale_ = true;
}

// A constraint at its bound is free where it would move into what it may do.
void Articulation::chooseFree() {
  for (JointRow& row : rows_) {
    if (!row.active || row.role != JointRow::Role::kConstraint || !isBounded(row)) continue;
    if (row.free && !row.lambda.isZero(0)) continue;
    const Vec3 wanted = row.lambda - (row.c - row.left + row.alpha * row.lambda);
    const bool free = clamped(row, wanted) != row.lambda;
    stale_ = stale_ || free != row.free;
    row.free = free;
  }
}

void Articulation::solvePositions(Kinds& kinds, const Configuration& at, bool first,
                                  std::span<const JointMass> masses,
                                  std::span<Displacement> moved) {
  evaluate(kinds, at, first);
  if (first) begin(masses, moved);
  if (first) chooseFree();
  if (stale_) factorize(masses);
  for (JointRow& row : rows_) row.evaluatedAt = along(row, moved);
  for (int round = 1;; ++round) {
    for (const int i : now_->rows) {
      const JointRow& row = rows_[i];
      const Vec3 since = along(row, moved) - row.evaluatedAt;
      right_[i] = -(row.c - row.left + since + row.alpha * row.lambda + row.yields * row.lambda);
    }
    substitute();
    if (round == kMostRounds || !holdAtBounds(moved)) break;
    factorize(masses);
  }
  apply(moved);
}

void Articulation::prepareVelocities(Kinds& kinds, const Configuration& at,
                                     std::span<const JointMass> masses) {
  for (JointRow& row : rows_) {
    row.free = row.active && !givesWay(row) && (!isBounded(row) || !row.lambda.isZero(0));
  }
  evaluate(kinds, at, false);
  factorize(masses);
}

void Articulation::solveVelocities(std::span<const JointMass> masses,
                                   std::span<Displacement> moved) {
  for (int round = 1;; ++round) {
    if (stale_) factorize(masses);
    for (const int i : now_->rows) right_[i] = -along(rows_[i], moved);
    substitute();
    if (round == kMostRounds || !holdAtBounds(moved)) break;
  }
  apply(moved);
}

void Articulation::forget() {
  for (JointRow& row : rows_) row.lambda.setZero();
}

void Articulation::finish(Kinds& kinds, double dt) const {
  for (const JointRow& row : rows_) {
    withKind(kinds, row.kind, [&](auto& kind) {
      using C = typename std::decay_t<decltype(kind)>::Item;
      if constexpr (C::kBodies != kMany) {
        kind.set.lambda[row.item].total = row.lambda.template head<C::kRows>();
        kind.set.lambda[row.item].step = dt;
      }
    });
  }
}

}  // namespace physics
