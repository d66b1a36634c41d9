// Contact rows, eight manifolds at a time, and the kernels that sweep over them.
//
// The unknowns are displacements of a substep, u = h v and theta = h w, in single precision: they
// lose 1e-7 of a displacement, and poses stay double. Rows are prepared once where contacts are
// looked for; within the substeps that follow, the gap of a point is
//   c = gap + n . (dA - dB) + (rA x n) . thA - (rB x n) . thB,   d, th: displaced since then (91)
// A manifold has up to four normal rows, and at their centre two of friction and one of twist.
//
// A contact gives way as the spring and damper of (117)-(124), as stiff as the substep resolves:
//   position   c > 0:  dlambda = -(J u + c) / A
//              else    dlambda = -(s J u + r c) / A - (1 - s) (lambda - held)
//                      r = min(s b, push / depth of the deepest)
//   velocity           dlambda = -(J u + max(c, 0)) / A, and friction on the disc of (96)-(101)
// with the total projected on lambda >= 0. What is deep is taken back by the same share at all
// points of a manifold, so that it does not tilt on its way out. `held` is a part of the load at
// the start: what is drawn at rest sags less. No include but this: it is compiled for several
// machines.
#pragma once

namespace physics {

// One body, 64 bytes: what it moves by in this substep, and has since the rows were prepared.
struct alignas(64) LaneMotion {
  float u[3] = {}, theta[3] = {}, pad[2] = {};     // this substep [m, rad]
  float du[3] = {}, dtheta[3] = {}, more[2] = {};  // since the rows were prepared
};

// What rows need of a body: 1/m and the symmetric world inverse inertia xx yy zz xy xz yz.
struct alignas(32) LaneMass {
  float inverse = 0;
  float inertia[6] = {};
  float pad = 0;
};

struct Softness {
  float scale = 1;  // s
  float rate = 0;   // b, of the overlap taken back in a substep
};

struct alignas(32) ContactBlock {
  static constexpr int kLanes = 8, kPoints = 4;
  struct Point {
    float torqueA[3][8], torqueB[3][8];  // r x n
    // I^-1 (r x n). Until rows are prepared: the arms r, from the centres [m].
    float turnA[3][8], turnB[3][8];
    float gap[8], lambda[8], inverse[8];  // 1/A; 0: no such point
    float open[8];                        // max(c, 0), of the substep's end
    float held[8];                        // of lambda, what the spring carries without giving way
    float lever[8];                       // from the centre of friction
  };
  struct Tangent {
    float d[3][8], torqueA[3][8], torqueB[3][8], turnA[3][8], turnB[3][8], lambda[8];
  };
  Point point[kPoints];
  Tangent tangent[2];
  float n[3][8];
  float massA[8], massB[8], inverse11[8], inverse12[8], inverse22[8];
  float twistA[3][8], twistB[3][8], twistInverse[8], twist[8];
  float staticFriction[8], dynamicFriction[8];
  float scale[8], rate[8];  // softness
  float change[8];          // sum of A dlambda^2 in the last velocity sweep
  int bodyA[8], bodyB[8];   // slots; 0 where nothing moves
  int contact[8];           // index of the contact, -1: an empty lane
};

struct ContactKernels {
  // Everything that follows from arms, n, gaps, lambda and bodies. `reach` [m]: gaps beyond it do
  // not count for the centre of friction.
  void (*prepare)(ContactBlock* blocks, int count, const LaneMass* masses, float reach);
  void (*warmStart)(ContactBlock* blocks, int count, LaneMotion* motions);
  void (*sweepPositions)(ContactBlock* blocks, int count, LaneMotion* motions, float push);
  // Before the velocity sweeps of a substep: how far points are open.
  void (*measure)(ContactBlock* blocks, int count, const LaneMotion* motions);
  void (*sweepVelocities)(ContactBlock* blocks, int count, LaneMotion* motions);
};

// Chosen once, by what the processor has.
const ContactKernels& contactKernels();
extern const ContactKernels kContactKernelsSse2, kContactKernelsAvx2;

}  // namespace physics
