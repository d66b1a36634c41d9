#include "tests/physics/order_cases.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"

namespace physics::testing {
namespace {

constexpr double kDuration = 0.4;  // s

BodyId addPoint(World& world, const Vec3& x, const Vec3& v = Vec3::Zero(), double mass = 1) {
  BodyDef def;
  def.mass = mass;
  def.pose.x = x;
  def.velocity.v = v;
  return world.add(def);
}

// A brick with three different moments, askew and turning.
BodyId brick(World& world, const Vec3& x, const Vec3& w = Vec3(0.5, -1, 2)) {
  BodyDef def;
  def.shape = Box{Vec3(0.8, 0.3, 0.5)};
  def.mass = 2;
  def.pose = {x, exponential(Vec3(0.3, -0.2, 0.5))};
  def.velocity.w = w;
  return world.add(def);
}

World pendulum(const Settings& s) {
  World world(s);
  DistanceDef rod;
  rod.bodies = {kWorldBody, addPoint(world, Vec3(0.6, -0.8, 0), Vec3(0, 0, 1))};
  world.add(rod);
  return world;
}

World threeLinks(const Settings& s) {
  World world(s);
  BodyId last = kWorldBody;
  for (int k = 1; k <= 3; ++k) {
    LinkDef link;
    link.bodies = {last, addPoint(world, Vec3(0.3 * k, 0, 0), Vec3(0, 0, 0.2 * k))};
    last = link.bodies[1];
    world.add(link);
  }
  return world;
}

// Two bricks of a chain that swings in space. They start with the velocities of a common turn.
World twoBricks(const Settings& s, Form form) {
  World world(s);
  const Vec3 w(0.5, -1, 2);
  BodyId last = kWorldBody;
  for (int k = 0; k < 2; ++k) {
    const BodyId body = brick(world, Vec3(0.4 + 0.8 * k, 0.1, 0), w);
    world.setVelocity(body, {w.cross(world.bodies().pose[body].x), w});
    BallSocketDef joint;
    joint.bodies = {last, body};
    joint.at = Vec3(0.8 * k, 0.1 * k, 0);
    joint.form = form;
    world.add(joint);
    last = body;
  }
  return world;
}
World ballSockets(const Settings& s) { return twoBricks(s, Form::kVector); }
World scalarBallSockets(const Settings& s) { return twoBricks(s, Form::kScalar); }

// A brick on a free carrier, joined by a hinge.
World hinge(const Settings& s) {
  World world(s);
  const Vec3 axis = Vec3(1, 2, -1).normalized(), at(0.4, 0.1, 0);
  const BodyId a = brick(world, Vec3::Zero(), Vec3(1, 0, 0.5));
  const BodyId b = brick(world, Vec3(0.8, 0.2, 0), Vec3(1, 0, 0.5) + 3 * axis);
  for (const BodyId body : {a, b}) {
    const Vec3 w = world.bodies().velocity[body].w;
    const Vec3 carried = Vec3(1, 0, 0.5).cross(at) + w.cross(world.bodies().pose[body].x - at);
    world.setVelocity(body, {carried, w});
  }
  BallSocketDef ball;
  ball.bodies = {a, b};
  ball.at = at;
  world.add(ball);
  AxleDef axle;
  axle.bodies = {a, b};
  axle.axis = axis;
  world.add(axle);
  return world;
}

World freeTop(const Settings& s) {
  World world(s);
  brick(world, Vec3::Zero(), Vec3(1, 4, 2));
  return world;
}

template <class Def>
World sprung(const Settings& s, Def def) {
  World world(s);
  def.bodies = {brick(world, Vec3::Zero()), brick(world, Vec3(1.5, 0.2, 0))};
  def.anchors = {Vec3(0.4, 0.1, 0.2), Vec3(-0.3, 0.1, 0.1)};
  world.add(def);
  return world;
}
World spring(const Settings& s) {
  SpringDef def;
  def.stiffness = 200;
  def.damping = 8;
  def.restLength = 0.5;
  return sprung(s, def);
}
World vectorSpring(const Settings& s) {
  SpringDef def;
  def.stiffness = 100;
  def.damping = 8;
  def.restLength = 0;
  return sprung(s, def);
}
World hardeningSpring(const Settings& s) {
  HardeningSpringDef def;
  def.stiffness = 50;
  def.cubic = 300;
  def.damping = 5;
  def.restLength = 0.5;
  return sprung(s, def);
}

World drive(const Settings& s) {
  World world(s);
  DriveDef def;
  def.bodies = {brick(world, Vec3::Zero()), brick(world, Vec3(2, 0, 0), Vec3(-1, 0, 1))};
  def.target = exponential(Vec3(0.4, 0.8, -0.3));
  def.damping = 1;
  world.add(def);
  return world;
}

World motors(const Settings& s) {
  World world(s);
  MotorTorqueDef torque;
  torque.bodies = {brick(world, Vec3::Zero()), brick(world, Vec3(2, 0, 0), Vec3(-1, 0, 1))};
  torque.axis = Vec3(1, 1, 0).normalized();
  torque.stallTorque = 2;
  torque.freeSpeed = 5;
  world.add(torque);
  return world;
}

World planets(const Settings& s) {
  World world(s);
  PointGravityDef def;
  def.bodies = {addPoint(world, Vec3::Zero(), Vec3(0, 0, -0.1), 5),
                addPoint(world, Vec3(1, 0, 0), Vec3(0, 1.5, 0.5), 1)};
  def.strength = 3;
  world.add(def);
  return world;
}

// A rope of five points with bending and drag; its whole length, where asked for, instead of links.
World rope(const Settings& s, bool whole) {
  World world(s);
  std::vector<BodyId> nodes;
  for (int k = 0; k < 5; ++k) {
    nodes.push_back(addPoint(world, Vec3(0.2 * k, 0.03 * k * k, 0), Vec3(0, 0, 0.3 * k * k), 0.2));
  }
  for (int k = 0; k < 4 && !whole; ++k) {
    LinkDef link;
    link.bodies = {nodes[k], nodes[k + 1]};
    world.add(link);
  }
  if (whole) {
    RopeLengthDef length;
    length.bodies = nodes;
    world.add(length);
  }
  for (int k = 0; k < 3; ++k) {
    BendDef bend;
    bend.bodies = {nodes[k], nodes[k + 1], nodes[k + 2]};
    bend.stiffness = 5;
    bend.damping = 0.1;
    world.add(bend);
  }
  for (const BodyId node : nodes) {
    DragDef drag;
    drag.bodies = {node};
    drag.coefficient = 0.2;
    drag.wind = Vec3(1, 0, 2);
    world.add(drag);
  }
  return world;
}
World linkedRope(const Settings& s) { return rope(s, false); }
World wholeRope(const Settings& s) { return rope(s, true); }

// A tetrahedron that keeps its volume, with springs for edges and wind on a face.
World tetrahedron(const Settings& s) {
  World world(s);
  const std::array<BodyId, 4> p{addPoint(world, Vec3(0, 0, 0)), addPoint(world, Vec3(1, 0, 0)),
                                addPoint(world, Vec3(0, 1.2, 0), Vec3(0, 0, 1)),
                                addPoint(world, Vec3(0, 0, 1), Vec3(0.5, 0, 0))};
  VolumeDef volume;
  volume.bodies = p;
  world.add(volume);
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      SpringDef edge;
      edge.bodies = {p[a], p[b]};
      edge.stiffness = 30;
      edge.damping = 0.5;
      edge.restLength = 1;
      world.add(edge);
    }
  }
  PanelDragDef panel;
  panel.bodies = {p[0], p[1], p[2]};
  panel.coefficient = 0.5;
  panel.wind = Vec3(0, 0, 3);
  world.add(panel);
  return world;
}

}  // namespace

std::vector<OrderCase> orderCases() {
  return {{"Pendulum", pendulum},
          {"ThreeLinks", threeLinks},
          {"BallSockets", ballSockets},
          {"ScalarBallSockets", scalarBallSockets},
          {"Hinge", hinge},
          {"FreeTop", freeTop},
          {"Spring", spring},
          {"VectorSpring", vectorSpring},
          {"HardeningSpring", hardeningSpring},
          {"Drive", drive},
          {"MotorTorque", motors},
          {"PointGravity", planets},
          {"Rope", linkedRope},
          {"RopeLength", wholeRope},
          {"Tetrahedron", tetrahedron}};
}

Settings smoothSettings(Stepping stepping, Method method, double duration, int steps) {
  Settings s;
  s.dt = duration;
  s.substeps = steps;
  s.iterations = method == Method::kDirect ? 12 : 80;
  s.method = method;
  s.stepping = stepping;
  s.gravity = Vec3(0, -9.81, 0);
  return s;
}

double distanceOf(const World& a, const World& b) {
  double largest = 0;
  for (int i = 0; i < a.bodyCount(); ++i) {
    const Pose &p = a.bodies().pose[i], &q = b.bodies().pose[i];
    largest = std::max({largest, (p.x - q.x).norm(), logarithm(p.q * q.q.conjugate()).norm()});
  }
  return largest;
}

double selfConvergence(const OrderCase& c, Stepping stepping, Method method, int steps) {
  std::vector<World> worlds;
  for (const int factor : {1, 2, 4}) {
    worlds.push_back(c.make(smoothSettings(stepping, method, kDuration, factor * steps)));
    worlds.back().step();
  }
  return std::log2(distanceOf(worlds[0], worlds[1]) / distanceOf(worlds[1], worlds[2]));
}

}  // namespace physics::testing
