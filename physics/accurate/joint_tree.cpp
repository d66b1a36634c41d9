// Trees of bodies on ball sockets, and of points on links.
#include "physics/accurate/joint_tree.h"

#include <algorithm>

#include "physics/accurate/lane_rows.h"

namespace physics {
namespace {

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

std::optional<JointTree> JointTree::of(std::shared_ptr<const JointTopology> topology,
                                       std::span<const Joint> joints,
                                       std::span<const Body> bodies) {
  const std::vector<JointShape>& shapes = topology->shapes;
  const bool isOfLinks =
      !joints.empty() && std::all_of(joints.begin(), joints.end(),
                                     [](const Joint& joint) { return joint.length > 0; });
  const auto fits = [&](const JointShape& shape) {
    return shape.bodyCount == 2 && (isOfLinks || shape.isGap);
  };
  const auto mayTurn = [&](const Body& body) {
    return !body.turns || (!isOfLinks && body.inertia.minCoeff() > 0);
  };
  JointTree tree;
  tree.bodiesOf_.assign(bodies.begin(), bodies.end());
  tree.jointsOf_.assign(joints.begin(), joints.end());
  tree.isOfLinks_ = isOfLinks;
  if (!topology->isTree || !std::all_of(shapes.begin(), shapes.end(), fits) ||
      !std::all_of(bodies.begin(), bodies.end(), mayTurn) || !tree.findWalk(*topology)) {
    return {};
  }
  tree.topology_ = std::move(topology);
  tree.layOut();
  return tree;
}

void JointTree::layOut() {
  std::size_t turners = isOfLinks_ ? jointsOf_.size() : 0;
  for (const Body& of : bodiesOf_) {
    TreeBody body;
    if (of.turns) body.turner = static_cast<int>(turners++);
    if (of.moves) body.mass = 1 / of.mass;
    for (int k = 0; k < 3; ++k) body.inertia[k] = of.inertia[k];
    bodies_.push_back(body);
  }
  motion_.resize(turners);
  start_.resize(turners);
  const std::size_t blocks = topology_->meetings.size(), numbers = isOfLinks_ ? 1 : 9;
  if (isOfLinks_) {
    alpha_.resize(3 * bodies_.size());
  } else {
    turns_.resize(turners);
  }
  joints_.resize(jointsOf_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].length = jointsOf_[i].length;
    for (int b = 0; b < 2; ++b) {
      for (int k = 0; k < 3; ++k) joints_[i].anchor[b][k] = jointsOf_[i].anchors[b][k];
    }
  }
  diagonal_.resize(numbers * joints_.size());
  lower_.resize(numbers * blocks);
  upper_.resize(numbers * blocks);
}

// From what stands, or else from the first. False: some is held in two ways, or not reached.
bool JointTree::findWalk(const JointTopology& topology) {
  std::vector<bool> known(bodiesOf_.size()), used(topology.shapes.size());
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = !bodiesOf_[i].moves;
  isFree_ = std::none_of(known.begin(), known.end(), [](bool is) { return is; });
  if (isFree_) known[0] = true;
  for (bool goesOn = true; goesOn;) {
    goesOn = false;
    for (std::size_t i = 0; i < used.size(); ++i) {
      const int* body = topology.shapes[i].body;
      if (used[i] || known[body[0]] == known[body[1]]) continue;
      walk_.push_back({static_cast<int>(i), known[body[0]] ? 0 : 1});
      known[body[0]] = known[body[1]] = used[i] = goesOn = true;
    }
  }
  return walk_.size() == used.size() &&
         std::all_of(known.begin(), known.end(), [](bool is) { return is; });
}

void JointTree::push(std::span<const Vec3> pulls, std::span<const Vec3> torques) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodiesOf_[i].moves) continue;
    for (int k = 0; k < 3; ++k) {
      bodies_[i].pull[k] = pulls[i][k];
      bodies_[i].torque[k] = torques[i][k];
    }
  }
}

TreeView JointTree::view() {
  const JointTopology& t = *topology_;
  return {bodies_.data(),
          motion_.data(),
          turns_.data(),
          alpha_.data(),
          joints_.data(),
          diagonal_.data(),
          lower_.data(),
          upper_.data(),
          static_cast<int>(bodies_.size()),
          static_cast<int>(joints_.size()),
          static_cast<int>(motion_.size()),
          t.shapes.data(),
          t.columns.data(),
          t.below.data(),
          t.updates.data(),
          t.meetings.data()};
}

// All lanes.
void JointTree::beginAt(std::size_t motion, const Quat& turn, const Vec3& omega) {
  const double q[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
  for (int l = 0; l < kTreeLanes; ++l) {
    for (int k = 0; k < 4; ++k) start_[motion].q[k].v[l] = q[k];
    for (int k = 0; k < 3; ++k) start_[motion].omega[k].v[l] = omega[k];
  }
}

// Links turn from where they are directed.
void JointTree::begin() {
  for (std::size_t i = 0; isOfLinks_ && i < joints_.size(); ++i) {
    const int* body = topology_->shapes[i].body;
    const Vec3 way = from_.pose[body[1]].x - from_.pose[body[0]].x, u = way.normalized();
    const Vec3 parting = from_.velocity[body[1]].v - from_.velocity[body[0]].v;
    for (int k = 0; k < 3; ++k) joints_[i].anchor[0][k] = u[k];
    beginAt(i, Quat::Identity(), u.cross(parting) / joints_[i].length);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodiesOf_[i].turns) beginAt(bodies_[i].turner, from_.pose[i].q, from_.velocity[i].w);
  }
  motion_ = start_;
}

void JointTree::begin(int lane) {
  for (std::size_t i = 0; i < motion_.size(); ++i) copyLane(start_[i], lane, motion_[i], lane);
}

void JointTree::takeEnd(int row, int lane) {
  TreeMotion* to = ends_.data() + row / kTreeLanes * motion_.size();
  for (std::size_t i = 0; i < motion_.size(); ++i) {
    copyLane(motion_[i], lane, to[i], row % kTreeLanes);
  }
}

// Half a step is made before the first kick and after the last one: that at the ends together.
void JointTree::run(int first, int columns, const IslandState& from, double time,
                    const TreeKernels& kernels) {
  from_ = from;
  time_ = time;
  begin();
  ends_.resize((columns + kTreeLanes - 1) / kTreeLanes * motion_.size());
  const LaneRows rows(first, columns);
  TreeView s = view();
  TreeNum h, way;
  std::fill_n(h.v, kTreeLanes, time / (first + columns - 1));  // lanes that are done go on, in vain
  for (int k = 0; k < rows.steps; ++k) {
    way = h;
    for (int row = 0; row < columns; ++row) {
      const auto [lane, step] = rows.of[row];
      if (step != k) continue;
      if (k > 0) begin(lane);
      h.v[lane] = time / (first + row);
      way.v[lane] = 0.5 * h.v[lane];
    }
    kernels.drift(s, way);
    (isOfLinks_ ? kernels.kickLinks : kernels.kickSockets)(s, h);
    for (int row = 0; row < columns; ++row) {
      const auto [lane, step] = rows.of[row];
      if (step + first + row == k + 1) takeEnd(row, lane);
    }
  }
  for (int row = 0; row < columns; row += kTreeLanes) {
    for (int l = 0; l < kTreeLanes; ++l) {
      way.v[l] = 0.5 * time / (first + std::min(row + l, columns - 1));
    }
    s.motion = ends_.data() + row / kTreeLanes * motion_.size();
    kernels.drift(s, way);
  }
}

void JointTree::end(int row, IslandState& state) const {
  const TreeMotion* from = ends_.data() + row / kTreeLanes * motion_.size();
  const int l = row % kTreeLanes;
  const auto turnOf = [&](std::size_t i) {
    const TreeNum* q = from[i].q;
    return Quat(q[0].v[l], q[1].v[l], q[2].v[l], q[3].v[l]);
  };
  state = from_;
  for (const Step& step : walk_) {
    if (!isOfLinks_) break;
    const double* start = joints_[step.joint].anchor[0];
    const Vec3 way = (step.from == 0 ? 1 : -1) * joints_[step.joint].length *
                     (turnOf(step.joint) * Vec3(start[0], start[1], start[2]));
    const int* body = topology_->shapes[step.joint].body;
    const int a = body[step.from], b = body[1 - step.from];
    state.pose[b].x = state.pose[a].x + way;
    state.velocity[b].v = state.velocity[a].v + vectorOf(from[step.joint].omega, l).cross(way);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodiesOf_[i].turns) continue;
    state.pose[i].q = turnOf(bodies_[i].turner);
    state.velocity[i].w = vectorOf(from[bodies_[i].turner].omega, l);
  }
  if (!isOfLinks_) walkSockets(state);
  if (isFree_) takeCentre(state);
}

void JointTree::place(IslandState& state) const {
  isOfLinks_ ? walkLinks(state) : walkSockets(state);
  if (isFree_) takeCentre(state);
}

void JointTree::walkSockets(IslandState& state) const {
  for (const Step& step : walk_) {
    const int* body = topology_->shapes[step.joint].body;
    const std::array<Vec3, 2>& anchors = jointsOf_[step.joint].anchors;
    const int a = body[step.from], b = body[1 - step.from];
    const Vec3 armA = state.pose[a].q * anchors[step.from];
    const Vec3 armB = state.pose[b].q * anchors[1 - step.from];
    state.pose[b].x = state.pose[a].x + armA - armB;
    state.velocity[b].v =
        state.velocity[a].v + state.velocity[a].w.cross(armA) - state.velocity[b].w.cross(armB);
  }
}

// What a link's bodies are apart, from the last one in; then from where it stands out.
void JointTree::walkLinks(IslandState& state) const {
  const auto ends = [&](const Step& step) {
    const int* body = topology_->shapes[step.joint].body;
    return std::array{body[step.from], body[1 - step.from]};
  };
  for (std::size_t k = walk_.size(); k-- > 0;) {
    const auto [a, b] = ends(walk_[k]);
    Vec3 &x = state.pose[b].x, &v = state.velocity[b].v;
    const Vec3 u = (x - state.pose[a].x).normalized(), parting = v - state.velocity[a].v;
    x = joints_[walk_[k].joint].length * u;
    v = parting - parting.dot(u) * u;
  }
  for (const Step& step : walk_) {
    const auto [a, b] = ends(step);
    state.pose[b].x += state.pose[a].x;
    state.velocity[b].v += state.velocity[a].v;
  }
}

// Of what flies: it knows nothing of joints. Nor does the momentum about it of one body alone.
void JointTree::takeCentre(IslandState& state) const {
  double mass = 0;
  Vec3 x = Vec3::Zero(), v = Vec3::Zero();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double* pull = bodies_[i].pull;
    const Vec3 fall = time_ * Vec3(pull[0], pull[1], pull[2]), &start = from_.velocity[i].v;
    mass += bodiesOf_[i].mass;
    v += bodiesOf_[i].mass * (start + fall - state.velocity[i].v);
    x += bodiesOf_[i].mass * (from_.pose[i].x + time_ * (start + 0.5 * fall) - state.pose[i].x);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    state.pose[i].x += x / mass;
    state.velocity[i].v += v / mass;
  }
  if (bodies_.size() > 1 || !bodiesOf_[0].turns) return;
  const Vec3& inertia = bodiesOf_[0].inertia;
  const double* torque = bodies_[0].torque;
  const Quat &before = from_.pose[0].q, &now = state.pose[0].q;
  const Vec3 momentum = before * inertia.cwiseProduct(before.conjugate() * from_.velocity[0].w) +
                        time_ * Vec3(torque[0], torque[1], torque[2]);
  state.velocity[0].w = now * (now.conjugate() * momentum).cwiseQuotient(inertia);
}

}  // namespace physics
