// What one frame of a simulation shows, as plain numbers. One list of members serves both ways.
#include "scenes/moment.h"

#include <type_traits>

namespace scenes {
namespace {

using physics::Vec3;

// Calls visit(name, number) with every number, in the order of the file.
template <class Metrics, class Visit>
void forEachNumber(Metrics& m, const Visit& visit) {
  visit("kinetic", m.kinetic);
  visit("potential", m.potential);
  visit("total", m.total);
  constexpr const char* kLinear[] = {"linear_x", "linear_y", "linear_z"};
  constexpr const char* kAngular[] = {"angular_x", "angular_y", "angular_z"};
  for (int i = 0; i < 3; ++i) visit(kLinear[i], m.linearMomentum[i]);
  for (int i = 0; i < 3; ++i) visit(kAngular[i], m.angularMomentum[i]);
  visit("overlap", m.overlap);
  visit("max_speed", m.maxSpeed);
  visit("contacts", m.contacts);
  visit("iterations", m.iterations);
  visit("asleep", m.asleep);
  visit("restarts", m.restarts);
  visit("fallbacks", m.fallbacks);
  visit("accuracy.accepted", m.accuracy.accepted);
  visit("accuracy.rejected", m.accuracy.rejected);
  visit("accuracy.order", m.accuracy.order);
  visit("accuracy.least", m.accuracy.least);
  visit("accuracy.estimate", m.accuracy.estimate);
  for (auto& error : m.errors) {
    visit(error.kind + ".largest", error.largest);
    visit(error.kind + ".sum", error.sum);
    visit(error.kind + ".worst", error.worst);
  }
}

template <class Arm, class Visit>
void forEachArmNumber(Arm& arm, const Visit& visit) {
  const auto visitVector = [&](auto& vector) {
    for (int i = 0; i < 3; ++i) visit("", vector[i]);
  };
  visitVector(arm.tip);
  visitVector(arm.target);
  visitVector(arm.followed);
  visit("", arm.error);
  for (auto* list : {&arm.pivots, &arm.toTip, &arm.centres, &arm.turns}) {
    for (auto& vector : *list) visitVector(vector);
  }
  for (auto& inertia : arm.inertia) {
    for (int i = 0; i < 9; ++i) visit("", inertia(i / 3, i % 3));
  }
  for (auto& angle : arm.turned) visit("", angle);
  visit("", arm.effort);
  visit("", arm.iterations);
  visit("", arm.held);
}

struct Writer {
  std::vector<double>& to;
  template <class Name, class Number>
  void operator()(const Name&, const Number& number) const {
    to.push_back(static_cast<double>(number));
  }
};

struct Reader {
  std::vector<double>::const_iterator& from;
  template <class Name, class Number>
  void operator()(const Name&, Number& number) const {
    number = static_cast<Number>(*from++);
  }
};

Vec3 vectorAt(const double* from) { return {from[0], from[1], from[2]}; }

void addVector(const Vec3& v, std::vector<double>& to) {
  to.insert(to.end(), {v.x(), v.y(), v.z()});
}

std::vector<double> armNumbers(const std::vector<physics::ArmReport>& arms) {
  std::vector<double> numbers;
  for (const physics::ArmReport& arm : arms) forEachArmNumber(arm, Writer{numbers});
  return numbers;
}

std::vector<double> metricNumbers(const FrameMetrics& metrics) {
  std::vector<double> numbers;
  forEachNumber(metrics, Writer{numbers});
  return numbers;
}

physics::ContactReport contactAt(const double* c) {
  return {static_cast<physics::BodyId>(c[0]),
          static_cast<physics::BodyId>(c[1]),
          vectorAt(c + 2),
          vectorAt(c + 5),
          c[8],
          vectorAt(c + 9)};
}

}  // namespace

MomentNumbers numbersOf(const Moment& moment) {
  MomentNumbers numbers;
  numbers.poses.reserve(MomentNumbers::kPose * moment.poses.size());
  for (const physics::Pose& pose : moment.poses) {
    addVector(pose.x, numbers.poses);
    numbers.poses.insert(numbers.poses.end(), {pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()});
  }
  numbers.velocities.reserve(MomentNumbers::kVelocity * moment.velocities.size());
  for (const physics::Velocity& velocity : moment.velocities) {
    addVector(velocity.v, numbers.velocities);
    addVector(velocity.w, numbers.velocities);
  }
  for (const physics::ContactReport& c : moment.contacts) {
    numbers.contacts.push_back(c.a);
    numbers.contacts.push_back(c.b);
    addVector(c.point, numbers.contacts);
    addVector(c.normal, numbers.contacts);
    numbers.contacts.push_back(c.gap);
    addVector(c.impulse, numbers.contacts);
  }
  numbers.arms = armNumbers(moment.arms);
  numbers.metrics = metricNumbers(moment.metrics);
  return numbers;
}

Moment momentFrom(const MomentNumbers& numbers, const Moment& like) {
  Moment moment = like;
  if (numbers.poses.size() == MomentNumbers::kPose * like.poses.size()) {
    for (std::size_t b = 0; b < like.poses.size(); ++b) {
      const double* p = &numbers.poses[MomentNumbers::kPose * b];
      moment.poses[b] = {vectorAt(p), {p[3], p[4], p[5], p[6]}};
    }
  }
  if (numbers.velocities.size() == MomentNumbers::kVelocity * like.velocities.size()) {
    for (std::size_t b = 0; b < like.velocities.size(); ++b) {
      const double* v = &numbers.velocities[MomentNumbers::kVelocity * b];
      moment.velocities[b] = {vectorAt(v), vectorAt(v + 3)};
    }
  }
  moment.contacts.clear();
  for (std::size_t i = 0; i + MomentNumbers::kContact <= numbers.contacts.size();
       i += MomentNumbers::kContact) {
    moment.contacts.push_back(contactAt(&numbers.contacts[i]));
  }
  if (numbers.arms.size() == armNumbers(like.arms).size()) {
    auto from = numbers.arms.begin();
    for (physics::ArmReport& arm : moment.arms) forEachArmNumber(arm, Reader{from});
  }
  if (numbers.metrics.size() == metricNumbers(like.metrics).size()) {
    auto from = numbers.metrics.begin();
    forEachNumber(moment.metrics, Reader{from});
  }
  return moment;
}

std::vector<std::string> numberNames(const FrameMetrics& metrics) {
  std::vector<std::string> names;
  forEachNumber(metrics, [&](const auto& name, const auto&) { names.emplace_back(name); });
  return names;
}

}  // namespace scenes
