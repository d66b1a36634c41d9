// What contacts see of the joints behind a body: columns of R, by the factor of the joints.
#include "physics/solver/articulation.h"
#include "physics/solver/joint_lanes.h"

namespace physics {

// The place of a body in the response of each lane, -1: no contact touches it there.
template <int W>
std::array<int, W> JointPack<W>::placesOf(std::size_t body) const {
  std::array<int, W> places;
  for (int l = 0; l < W; ++l) {
    const bool asks = l < lanes_ && of_[l]->response_.size() > 0;
    places[l] = asks ? of_[l]->response_.at[body] : -1;
  }
  return places;
}

// An impulse of one on a component of a body, in the units of its lane, as if it had no joints.
template <int W>
void JointPack<W>::pushAlone(std::size_t body, const std::array<int, W>& places, int component) {
  for (JointBody<W>& other : bodies_) {
    for (int k = 0; k < 3; ++k) other.u[k] = other.theta[k] = Num<W>{};
  }
  JointBody<W>& pushed = bodies_[body];
  for (int l = 0; l < lanes_; ++l) {
    if (places[l] < 0) continue;
    if (component < 3) {
      pushed.u[component].v[l] = pushed.inverseMass.v[l];
      continue;
    }
    const Vec3 torque =
        torqueOf(of_[l]->response_.masses[places[l]], Vec3::Unit(component - 3).eval());
    write(pushed.theta, l, turnBy(pushed, l, torque));
  }
}

template <int W>
void JointPack<W>::noteResponse(const std::array<int, W>& from, int component) {
  for (int l = 0; l < lanes_; ++l) {
    if (from[l] < 0) continue;
    JointResponse& response = of_[l]->response_;
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
      const int to = response.at[body];
      if (to < 0) continue;
      float* column = response.block(to, from[l]) + JointResponse::kColumn * component;
      const Vec3 u = read(bodies_[body].u, l);
      const Vec3 turn = turnOf(inverseOf(response.masses[to]), read(bodies_[body].theta, l));
      for (int k = 0; k < 3; ++k) {
        column[k] = static_cast<float>(u[k]);
        column[3 + k] = static_cast<float>(turn[k]);
      }
    }
  }
}

template <int W>
void JointPack<W>::respond() {
  open_ = {};  // nothing comes to a bound
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const std::array<int, W> places = placesOf(body);
    if (std::all_of(places.begin(), places.end(), [](int place) { return place < 0; })) continue;
    for (int component = 0; component < 6; ++component) {
      pushAlone(body, places, component);
      jointKernels<W>().follow(view());
      noteResponse(places, component);
    }
  }
}

template void JointPack<1>::respond();
template void JointPack<4>::respond();
template void JointPack<8>::respond();

}  // namespace physics
