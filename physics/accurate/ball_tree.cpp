// Trees of bodies on ball sockets.
#include "physics/accurate/ball_tree.h"

#include <algorithm>

namespace physics {
namespace {

// Motions of 1, 2, ... k steps are k steps in each lane: k; k - 1 and 1; k - 2 and 2 ...
struct LanePlace {
  int lane, step;  // the step of the lane that it begins with
};
LanePlace placeOf(int n, int columns) {
  const int other = columns - n;
  return n >= other ? LanePlace{other, 0} : LanePlace{n, other};
}

void copyLane(const TreeMotion& from, int lane, TreeMotion& to, int toLane) {
  for (int k = 0; k < 4; ++k) to.q[k].v[toLane] = from.q[k].v[lane];
  for (int k = 0; k < 3; ++k) to.omega[k].v[toLane] = from.omega[k].v[lane];
}

Vec3 vectorOf(const TreeNum* of, int lane) { return {of[0].v[lane], of[1].v[lane], of[2].v[lane]}; }

}  // namespace

const TreeKernels& treeKernels() {
  static const bool wide = __builtin_cpu_supports("avx2");
  return wide ? kTreeKernelsAvx2 : kTreeKernelsSse2;
}

std::optional<BallTree> BallTree::of(std::shared_ptr<const JointTopology> topology,
                                     std::span<const std::array<Vec3, 2>> anchors,
                                     std::span<const Body> bodies) {
  const std::vector<JointShape>& shapes = topology->shapes;
  const bool isOfGaps = std::all_of(shapes.begin(), shapes.end(), [](const JointShape& shape) {
    return shape.isGap && shape.bodyCount == 2;
  });
  const bool turnAnyWay = std::all_of(bodies.begin(), bodies.end(), [](const Body& body) {
    return !body.turns || body.inertia.minCoeff() > 0;
  });
  BallTree tree;
  tree.of_.assign(bodies.begin(), bodies.end());
  if (shapes.empty() || !topology->isTree || !isOfGaps || !turnAnyWay) return {};
  if (!tree.findLinks(*topology)) return {};
  tree.topology_ = std::move(topology);
  tree.anchors_.assign(anchors.begin(), anchors.end());
  for (const Body& of : bodies) {
    TreeBody body;
    body.turns = of.turns;
    if (of.moves) body.mass = 1 / of.mass;
    for (int k = 0; k < 3; ++k) body.inertia[k] = of.inertia[k];
    tree.bodies_.push_back(body);
  }
  tree.motion_.resize(bodies.size());
  tree.start_.resize(bodies.size());
  tree.turns_.resize(bodies.size());
  tree.joints_.resize(shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (int b = 0; b < 2; ++b) {
      for (int k = 0; k < 3; ++k) tree.joints_[i].anchor[b][k] = anchors[i][b][k];
    }
  }
  tree.diagonal_.resize(9 * shapes.size());
  tree.lower_.resize(9 * tree.topology_->meetings.size());
  tree.upper_.resize(tree.lower_.size());
  return tree;
}

// From what stands, or else from the first. False: some is held in two ways, or not reached.
bool BallTree::findLinks(const JointTopology& topology) {
  std::vector<bool> known(of_.size()), used(topology.shapes.size());
  for (std::size_t i = 0; i < of_.size(); ++i) known[i] = !of_[i].moves;
  isFree_ = std::none_of(known.begin(), known.end(), [](bool is) { return is; });
  if (isFree_) known[0] = true;
  for (bool goesOn = true; goesOn;) {
    goesOn = false;
    for (std::size_t i = 0; i < used.size(); ++i) {
      const int* body = topology.shapes[i].body;
      if (used[i] || known[body[0]] == known[body[1]]) continue;
      links_.push_back({static_cast<int>(i), known[body[0]] ? 0 : 1});
      known[body[0]] = known[body[1]] = used[i] = goesOn = true;
    }
  }
  return links_.size() == used.size() &&
         std::all_of(known.begin(), known.end(), [](bool is) { return is; });
}

void BallTree::push(std::span<const Vec3> pulls, std::span<const Vec3> torques) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      bodies_[i].pull[k] = pulls[i][k];
      bodies_[i].torque[k] = torques[i][k];
    }
  }
}

TreeView BallTree::view() {
  const JointTopology& t = *topology_;
  return {bodies_.data(),
          motion_.data(),
          turns_.data(),
          joints_.data(),
          diagonal_.data(),
          lower_.data(),
          upper_.data(),
          static_cast<int>(bodies_.size()),
          static_cast<int>(joints_.size()),
          t.shapes.data(),
          t.columns.data(),
          t.below.data(),
          t.updates.data(),
          t.meetings.data()};
}

// All lanes.
void BallTree::begin() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].turns) continue;
    const Quat& q = from_.pose[i].q;
    const double turn[4] = {q.w(), q.x(), q.y(), q.z()};
    for (int l = 0; l < kTreeLanes; ++l) {
      for (int k = 0; k < 4; ++k) start_[i].q[k].v[l] = turn[k];
      for (int k = 0; k < 3; ++k) start_[i].omega[k].v[l] = from_.velocity[i].w[k];
    }
  }
  motion_ = start_;
}

void BallTree::begin(int lane) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) copyLane(start_[i], lane, motion_[i], lane);
}

void BallTree::takeEnd(int n, int lane) {
  TreeMotion* to = ends_.data() + (n - 1) / kTreeLanes * bodies_.size();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    copyLane(motion_[i], lane, to[i], (n - 1) % kTreeLanes);
  }
}

// Half a step is made before the first kick and after the last one: that at the ends together.
void BallTree::run(int columns, const IslandState& from, double time, const TreeKernels& kernels) {
  from_ = from;
  time_ = time;
  begin();
  ends_.resize((columns + kTreeLanes - 1) / kTreeLanes * bodies_.size());
  TreeView s = view();
  TreeNum h, way;
  std::fill_n(h.v, kTreeLanes, time / columns);
  for (int k = 0; k < columns; ++k) {
    way = h;
    for (int n = 1; n <= columns; ++n) {
      const LanePlace place = placeOf(n, columns);
      if (place.step != k) continue;
      if (k > 0) begin(place.lane);
      h.v[place.lane] = time / n;
      way.v[place.lane] = 0.5 * time / n;
    }
    kernels.drift(s, way);
    kernels.kick(s, h);
    for (int n = 1; n <= columns; ++n) {
      const LanePlace place = placeOf(n, columns);
      if (place.step + n - 1 == k) takeEnd(n, place.lane);
    }
  }
  for (int first = 0; first < columns; first += kTreeLanes) {
    for (int l = 0; l < kTreeLanes; ++l) {
      way.v[l] = 0.5 * time / std::min(first + l + 1, columns);
    }
    s.motion = ends_.data() + first / kTreeLanes * bodies_.size();
    kernels.drift(s, way);
  }
}

void BallTree::end(int n, IslandState& state) const {
  const TreeMotion* from = ends_.data() + (n - 1) / kTreeLanes * bodies_.size();
  const int l = (n - 1) % kTreeLanes;
  state = from_;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].turns) continue;
    const TreeNum* q = from[i].q;
    state.pose[i].q = Quat(q[0].v[l], q[1].v[l], q[2].v[l], q[3].v[l]);
    state.velocity[i].w = vectorOf(from[i].omega, l);
  }
  place(state);
}

void BallTree::place(IslandState& state) const {
  for (const TreeLink& link : links_) {
    const JointShape& shape = topology_->shapes[link.joint];
    const int a = shape.body[link.from], b = shape.body[1 - link.from];
    const Vec3 armA = state.pose[a].q * anchors_[link.joint][link.from];
    const Vec3 armB = state.pose[b].q * anchors_[link.joint][1 - link.from];
    state.pose[b].x = state.pose[a].x + armA - armB;
    state.velocity[b].v =
        state.velocity[a].v + state.velocity[a].w.cross(armA) - state.velocity[b].w.cross(armB);
  }
  if (!isFree_) return;
  // Its centre of mass knows nothing of joints.
  double mass = 0;
  Vec3 x = Vec3::Zero(), v = Vec3::Zero();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double* pull = bodies_[i].pull;
    const Vec3 fall = time_ * Vec3(pull[0], pull[1], pull[2]), &start = from_.velocity[i].v;
    mass += of_[i].mass;
    v += of_[i].mass * (start + fall - state.velocity[i].v);
    x += of_[i].mass * (from_.pose[i].x + time_ * (start + 0.5 * fall) - state.pose[i].x);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    state.pose[i].x += x / mass;
    state.velocity[i].v += v / mass;
  }
}

}  // namespace physics
