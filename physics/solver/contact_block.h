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
//              else    dlambda = -(s J u + r c) / A - (1 - s) lambda
//                      r = min(s b, push / depth of the deepest), s b for what it is drawn by
//   velocity           dlambda = -(J u + max(c, 0)) / A, and friction on the disc of (96)-(101)
// with the total projected on lambda >= 0. What is deep is taken back by the same share at all
// points of a manifold, so that it does not tilt on its way out, and about its bodies; without
// friction on the push. c is counted from where the spring
// carries `held`, the load at the start: what is drawn at rest stays where it is, and the law about
// it is the same as anywhere. No include but this: it is compiled for several machines.
#pragma once

namespace physics {

// One body, 64 bytes: what it moves by in this substep, and has since the rows were prepared. Turns
// are in units in which its inertia is one: theta = root * turn, inverse inertia = root root^T, so
// that a row has one vector, w = root^T (r x n), for the rate that it sees and the turn it gives.
struct alignas(64) LaneMotion {
  float u[3] = {}, turn[3] = {}, pad[2] = {};  // this substep [m, sqrt(kg) m]
  float du[3] = {}, dturn[3] = {};             // since the rows were prepared
  // Of its overlaps that the push speed limits, and of its neighbours', when rows were prepared
  // [m].
  float deepest = 0, own = 0;
};

// What rows need of a body: 1/m, and the lower triangle 00 10 20 11 21 22 of the root. Where
// nothing turns the body the root is kUnturned: its turns are seen, and what it is given is lost.
struct alignas(32) LaneMass {
  static constexpr float kUnturned = 1.f / (1 << 30) / (1 << 10);  // squared a number still, 1e-24
  float root[6] = {};
  float inverse = 0, pad = 0;
};
// What a lane moved by when its body last knew of it.
struct alignas(32) LaneStart {
  float u[3] = {}, turn[3] = {}, pad[2] = {};
};

struct Softness {
  float scale = 1;  // s
  float rate = 0;   // b, of the overlap taken back in a substep
};

struct alignas(32) ContactBlock {
  static constexpr int kLanes = 8, kPoints = 4, kCouplings = 6;
  struct Point {
    float wA[3][8], wB[3][8];     // until rows are prepared: the arms r, from the centres [m]
    float lambda[8], inverse[8];  // 1/A; 0: no such point
    float open[8];                // max(c, 0), of the substep's end
    float lever[8];               // from the centre of friction
  };
  struct Tangent {
    float d[3][8], wA[3][8], wB[3][8], lambda[8];
    float twisted[8];  // what a twist of one changes its rate by
  };
  // First what every velocity sweep reads.
  int bodyA[8], bodyB[8];  // slots; 0 where nothing moves
  float massA[8], massB[8], n[3][8];
  Point point[kPoints];
  float coupling[kCouplings][8];  // J M^-1 J^T between points 01 02 03 12 13 23
  float twistA[3][8], twistB[3][8], twistInverse[8], twist[8];
  Tangent tangent[2];
  float inverse11[8], inverse12[8], inverse22[8];
  float staticFriction[8], dynamicFriction[8];
  float gap[kPoints][8];
  float held[kPoints][8];   // what it carries where the bodies just touch
  float drawn[kPoints][8];  // by so much it is compressed there [m]
  float lasted[8];          // what its points carried before the last substep
  float scale[8], rate[8];  // softness
  float push[8];            // overlap is taken back in a substep by no more [m]
  float change[2][8];       // sum of A dlambda^2 in the last velocity sweep, and the one before
  int contact[8];           // index of the contact, -1: an empty lane
  int points = kPoints;     // no lane has more
  int colour = -1;          // blocks of one, from 0 on, share no body that moves
};

enum class ContactRows : char { kAll, kNormal, kFriction };

struct PositionSweep {
  // What a spring is drawn by under the load that it carries now does not count as overlap, as what
  // it is drawn by under `held` does not.
  bool isDrawnByLoad = false;
  bool onlyDeep = false;  // only those of bodies that have something deep about them
};

// Where a contact's friction acts: amid its points, or where the pressure of what they carry does.
// Rocking, that is the edge that is stood on; amid the points the load's noise in heaps is not
// seen.
struct FrictionAt {
  float reach;          // m: points with larger gaps do not count, where none carries
  bool byLoad = false;  // true: by what they carry
};

// What the position sweep takes back at each point, and how much of the way is a spring's.
struct alignas(32) PositionAims {
  float aim[ContactBlock::kPoints][8], scale[ContactBlock::kPoints][8];
};

struct VelocitySweep {
  ContactRows rows = ContactRows::kAll;
  bool first = false;  // of a substep: gaps are measured
  int left = 2;        // that follow in it: of the last two the change is summed up
};

struct ContactSweeps {
  void (*warmStart)(ContactBlock* blocks, int count, LaneMotion* motions);
  void (*sweepPositions)(ContactBlock* blocks, int count, LaneMotion* motions, PositionSweep which);
  void (*sweepVelocities)(ContactBlock* blocks, int count, LaneMotion* motions,
                          VelocitySweep which);
};

struct ContactKernels : ContactSweeps {
  // Everything that follows from arms, n, gaps, lambda and bodies.
  void (*prepare)(ContactBlock* blocks, int count, const LaneMass* masses, FrictionAt friction);
  void (*give)(const ContactBlock* blocks, int count, LaneMotion* motions);  // what lanes carry
  // lambda^T J u of each lane: eight numbers to a block.
  void (*measureWork)(const ContactBlock* blocks, int count, const LaneMotion* motions,
                      float* work);
  void (*findAims)(const ContactBlock* blocks, int count, const LaneMotion* motions,
                   PositionSweep which, PositionAims* aims);
  void (*measure)(ContactBlock* blocks, int count, const LaneMotion* motions);  // `open`
  // As velocities where the bodies stand: of the loads that hold them there.
  void (*balance)(ContactBlock* blocks, int count, LaneMotion* motions);
};

// Chosen once, by what the processor has. With AVX-512 two blocks of a colour are swept at a time.
const ContactKernels& contactKernels();
extern const ContactKernels kContactKernelsSse2, kContactKernelsAvx2;
extern const ContactSweeps kContactSweepsAvx512;

}  // namespace physics
