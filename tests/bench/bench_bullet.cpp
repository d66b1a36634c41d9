// Bullet on the pyramid of bench_step, at its defaults (h = 1/60, ten iterations, one thread, no
// sleeping): run side by side, it gives the ratio that the printed milliseconds of two machines
// cannot.
#include <benchmark/benchmark.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

namespace {

struct Pyramid {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadPhase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadPhase, &solver, &configuration};
  btStaticPlaneShape ground{btVector3(0, 1, 0), 0};
  btBoxShape box{btVector3(0.5f, 0.5f, 0.5f)};
  std::vector<std::unique_ptr<btRigidBody>> bodies;

  explicit Pyramid(int base) {
    world.setGravity(btVector3(0, btScalar(-9.81), 0));
    add(0, &ground, btVector3(0, 0, 0));
    for (int row = 0; row < base; ++row) {
      for (int k = 0; k < base - row; ++k) {
        add(1, &box, btVector3(btScalar(k) - btScalar(base - row) / 2, btScalar(row) + 0.5f, 0));
      }
    }
  }
  ~Pyramid() {
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }
  void add(btScalar mass, btCollisionShape* shape, const btVector3& position) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
    info.m_friction = btScalar(0.6);
    info.m_startWorldTransform = btTransform(btQuaternion::getIdentity(), position);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies.back().get());
  }
  double largestOverlap() {
    double largest = 0;
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(m);
      for (int k = 0; k < manifold->getNumContacts(); ++k) {
        largest = std::max(largest, -double(manifold->getContactPoint(k).getDistance()));
      }
    }
    return largest;
  }
};

void bulletPyramid20(benchmark::State& state) {
  Pyramid pyramid(20);
  for (int k = 0; k < 60; ++k) pyramid.world.stepSimulation(btScalar(1.0 / 60), 0);
  double overlap = 0;
  for (auto _ : state) {
    pyramid.world.stepSimulation(btScalar(1.0 / 60), 0);
    state.PauseTiming();
    overlap = std::max(overlap, pyramid.largestOverlap());
    state.ResumeTiming();
  }
  state.counters["overlap_mm"] = 1e3 * overlap;
}

}  // namespace

BENCHMARK(bulletPyramid20)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
