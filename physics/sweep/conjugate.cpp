// Conjugate acceleration.
#include "physics/sweep/conjugate.h"

namespace physics {
namespace {

Vec3 impulseOf(const ContactPointState& p, const Vec3& n) {
  return p.normalTotal * n + p.frictionTotal;
}

template <class F>
void forEachPoint(Contacts& contacts, F&& f) {
  std::size_t next = 0;
  for (ContactPair& pair : contacts.pairs) {
    for (int k = 0; k < pair.count; ++k) f(pair, pair.points[k], next++);
  }
}

}  // namespace

void Conjugate::begin(const Contacts& contacts) {
  std::size_t count = 0;
  for (const ContactPair& pair : contacts.pairs) count += static_cast<std::size_t>(pair.count);
  before_.assign(count, Vec3::Zero());
  direction_.assign(count, Vec3::Zero());
  last_ = 0;
  std::size_t next = 0;
  for (const ContactPair& pair : contacts.pairs) {
    for (int k = 0; k < pair.count; ++k) {
      before_[next++] = impulseOf(pair.points[k], pair.points[k].normal);
    }
  }
}

void Conjugate::accelerate(Contacts& contacts, Bodies& bodies) {
  double square = 0;
  forEachPoint(contacts, [&](ContactPair&, ContactPointState& p, std::size_t i) {
    square += p.resistance * (impulseOf(p, p.normal) - before_[i]).squaredNorm();
  });
  const bool restart = !(last_ > 0) || square > last_;
  const double beta = restart ? 0 : square / last_;
  last_ = square;
  forEachPoint(contacts, [&](ContactPair&, ContactPointState& p, std::size_t i) {
    const Vec3 now = impulseOf(p, p.normal), gradient = before_[i] - now;
    const Vec3 extra = beta * direction_[i];
    direction_[i] = extra - gradient;
    before_[i] = now + extra;
    const double along = extra.dot(p.normal);
    p.normalTotal += along;
    p.frictionTotal += extra - along * p.normal;
    p.extra = extra;
  });
  if (restart) return;
  for (ContactPair& pair : contacts.pairs) push(pair, bodies);
}

}  // namespace physics
