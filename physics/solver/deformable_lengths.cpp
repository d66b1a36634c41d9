// Total lengths of a cloth whose links give way: rows of many bodies, which would fill up the
// factor of its points. They are solved with it all the same, by what it answers to each of them:
//   (alpha + J H^-1 J^T) mu = -(c + J d)   for the change mu of those that are not slack
#include <Eigen/Cholesky>

#include "physics/solver/deformable.h"

namespace physics {

using namespace swept;

template <class F>
void Deformable::forEachLength(F&& f) {
  if (points_->lengths.empty()) return;
  auto next = points_->lengths.begin();
  for (SweptRow<1>& swept : std::get<std::vector<SweptRow<1>>>(rows_.lists)) {
    if (swept.isLength && swept.isAtOnce) f(swept, *next++);
  }
}

void Deformable::takeLengthsAtOnce() {
  forEachRow(rows_, [&](SweptItem& swept) {
    if (!swept.isLength || swept.isImplied) return;
    swept.isAtOnce = true;
    points_->lengths.emplace_back();
  });
}

void Deformable::layOutLengths(std::vector<std::array<int, 2>>& pieces) {
  forEachLength([&](SweptRow<1>& swept, PointFactor::Length& length) {
    const std::size_t count = swept.bodies.size();
    length.place.clear();
    for (const BodyId body : swept.bodies) length.place.push_back(placeOf(body));
    length.turning.assign(count - 1, Mat3::Zero());
    length.given.resize(count, Vec3::Zero());
    length.push.resize(count);
    for (std::size_t p = 1; p < count; ++p) {
      pieces.push_back({length.place[p - 1], length.place[p]});
    }
  });
}

void Deformable::takeLengths(bool first) {
  forEachLength([&](SweptRow<1>& swept, PointFactor::Length& length) {
    length.answer.clear();
    if (first) std::fill(length.given.begin(), length.given.end(), Vec3::Zero());
    std::fill(length.turning.begin(), length.turning.end(), Mat3::Zero());
    if (!swept.swept) return;
    const std::size_t count = swept.bodies.size();
    length.gives = swept.alpha(0, 0) + gives_ * swept.own;
    if (first) {
      length.held = isBounded(swept) && swept.pulled.isZero(0) && !(swept.c[0] > 0);
    }
    const double piece = swept.length / static_cast<double>(count - 1);
    Vec3 along = Vec3::Zero();
    for (std::size_t p = 1; p < count; ++p) {
      along += swept.linear[p - 1].j.transpose();
      length.turning[p - 1] = turningStiffness(along, -swept.pulled[0], piece);
    }
  });
}

void Deformable::aimAtLengths(std::span<const Displacement> moved) {
  PointFactor& f = *points_;
  forEachLength([&](SweptRow<1>& swept, PointFactor::Length& length) {
    if (!swept.swept) return;
    length.next = length.held ? -swept.lambda[0] : 0;
    for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
      length.push[b] =
          swept.linear[b].j.transpose() * (swept.lambda[0] + length.next) - length.given[b];
    }
    for (std::size_t p = 1; p < swept.bodies.size(); ++p) {
      const Vec3 by = turnedBy(length.place[p - 1], moved) - turnedBy(length.place[p], moved);
      const Vec3 push = length.turning[p - 1] * by;
      length.push[p - 1] -= push;
      length.push[p] += push;
    }
    for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
      if (length.place[b] >= 0) f.change[length.place[b]] += length.push[b];
    }
  });
}

double Deformable::changeAlong(const SweptRow<1>& swept, const PointFactor::Length& length,
                               std::span<const Vec3> change) const {
  double sum = 0;
  for (std::size_t b = 0; b < length.place.size(); ++b) {
    if (length.place[b] >= 0) sum += swept.linear[b].j.dot(change[length.place[b]]);
  }
  return sum;
}

// What the factor answers to J^T of lengths, several at a time.
void Deformable::askFactor(std::span<const FreeLength> lengths) {
  PointFactor& f = *points_;
  f.sides.assign(f.change.size(), BlockFactor<3>::Sides::Zero());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const auto& [swept, length, error] = lengths[i];
    for (std::size_t b = 0; b < length->place.size(); ++b) {
      if (length->place[b] < 0) continue;
      f.sides[length->place[b]].col(i) += swept->linear[b].j.transpose();
    }
  }
  f.factor.solve(f.sides);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    auto& answer = lengths[i].length->answer;
    answer.resize(f.sides.size());
    for (std::size_t k = 0; k < f.sides.size(); ++k) answer[k] = f.sides[k].col(i);
  }
}

// d and the change of lambda, of those that are not slack.
void Deformable::solveLengths(std::span<const Displacement> moved) {
  PointFactor& f = *points_;
  std::vector<FreeLength> free, unasked;
  forEachLength([&](SweptRow<1>& swept, PointFactor::Length& length) {
    if (!swept.swept || length.held) return;
    free.push_back({&swept, &length, swept.constant[0] + along(swept, moved)[0]});
    if (length.answer.empty()) unasked.push_back(free.back());
  });
  const std::span<const FreeLength> all(unasked);
  for (std::size_t k = 0; k < all.size(); k += BlockFactor<3>::kSides) {
    askFactor(all.subspan(k, std::min<std::size_t>(BlockFactor<3>::kSides, all.size() - k)));
  }
  if (free.empty()) return;
  const auto count = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd matrix(count, count);
  Eigen::VectorXd right(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [swept, length, error] = free[i];
    right[i] = -error - changeAlong(*swept, *length, f.change);
    for (Eigen::Index j = 0; j <= i; ++j) {
      matrix(i, j) = changeAlong(*swept, *length, free[j].length->answer);
    }
    matrix(i, i) += length->gives;
  }
  const Eigen::VectorXd change = matrix.selfadjointView<Eigen::Lower>().ldlt().solve(right);
  for (Eigen::Index i = 0; i < count; ++i) {
    PointFactor::Length& length = *free[i].length;
    length.next = change[i];
    for (std::size_t k = 0; k < f.change.size(); ++k) f.change[k] += change[i] * length.answer[k];
  }
}

bool Deformable::chooseLengths(bool positions, std::span<const Displacement> moved) {
  bool any = false;
  forEachLength([&](SweptRow<1>& swept, PointFactor::Length& length) {
    if (!swept.swept || !isBounded(swept)) return;
    bool held = length.held;
    if (!held) {
      const SweptRow<1>::Vector wanted(swept.lambda[0] + length.next);
      held = clamped<1>(swept, wanted) != wanted;
    } else if (positions) {
      held = !(swept.constant[0] + along(swept, moved)[0] +
                   changeAlong(swept, length, points_->change) >
               0);
    }
    any = any || held != length.held;
    length.held = held;
  });
  return any;
}

void Deformable::takeLengthChange(double share, std::span<const JointMass> masses,
                                  std::span<Displacement> moved) {
  const auto change = [&](int place) -> Vec3 {
    return place < 0 ? Vec3::Zero().eval() : points_->change[place];
  };
  forEachLength([&](SweptRow<1>& swept, PointFactor::Length& length) {
    if (!swept.swept) return;
    if (!length.held) {
      for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
        length.push[b] += swept.linear[b].j.transpose() * length.next;
      }
    }
    for (std::size_t p = 1; p < swept.bodies.size(); ++p) {
      const Vec3 by = change(length.place[p - 1]) - change(length.place[p]);
      const Vec3 push = length.turning[p - 1] * by;
      length.push[p - 1] -= push;
      length.push[p] += push;
    }
    swept.lambda[0] += share * length.next;
    for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
      length.given[b] += share * length.push[b];
      moved[swept.bodies[b]].u += masses[swept.bodies[b]].inverse * share * length.push[b];
    }
  });
}

// Those that pulled go on: J u = 0.
void Deformable::prepareLengthVelocities() {
  forEachLength([&](SweptRow<1>& swept, PointFactor::Length& length) {
    if (!swept.swept) return;
    swept.constant.setZero();
    length.held = length.held || isSlack(swept);
    for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
      length.given[b] = swept.linear[b].j.transpose() * swept.lambda[0];
    }
  });
}

}  // namespace physics
