// How articulations of equal topology lie side by side, one to a lane: the memory that the kernels
// of joint_kernels.h work in. Plain numbers, so that what is compiled for wider registers shares no
// code with anything else.
#pragma once

#include "physics/solver/contact_block.h"

namespace physics {

// Kinds that the kernels evaluate themselves, and what is fixed of one, in body frames:
//   gap    its two anchors
//   cone   its two axes, the angle and its cosine
//   twist  the axis, the reference w x y z, and the bounds and the tangents of their halves
enum class JointSeen : char { kByKind, kGap, kCone, kTwist };
constexpr int kJointFixed = 11;

template <int W>
struct alignas(8 * W) Num {
  double v[W];
};

// A body that rows act on. Turns are w, x, y, z; the inertia is M^-1's and the stiffness geometric,
// xx yy zz xy xz yz, world.
template <int W>
struct JointBody {
  Num<W> startX[3], startQ[4], x[3], q[4];
  Num<W> u[3], theta[3];          // what it moves by in this substep
  Num<W> seenU[3], seenTheta[3];  // and did where its rows were evaluated
  Num<W> inverseMass, inertia[6], stiffness[6];
  Num<W> back[3], backQ[4];  // the turn that arms are taken back by, and q then
};

// Of a body where the factor was made: `theta`, and the determinant of `inertia`.
template <int W>
struct JointFactored {
  Num<W> theta[3], volume;
};

// What factorizing leaves of a row: M^-1 J^T by bodies and rows, epsilon A, A_ii and the inverse of
// D_ii, lower triangles by rows.
template <int W>
struct JointFactor {
  Num<W> response[2][9], yields, diagonal[6], inverse[6];
};

// One constraint or force. J is by rows; that of a gap is +-1 and the cross product with `angular`.
template <int W>
struct JointLanes {
  Num<W> free;     // 1: lambda is solved for; 0: it is held
  Num<W> carried;  // 1: of a limit, it did in the last substep
  Num<W> c[3], left[3], lambda[3], right[3];
  Num<W> linear[2][9], angular[2][9], arm[2][3];
  Num<W> fixed[kJointFixed];  // of what the kernels evaluate: see JointSeen
  Num<W> alpha[6], regularisation, low, high, longest;
};

// What articulations of equal topology share. Rows are in the order of elimination and 1 or 3 high;
// of 3 the last one may be empty.
struct JointShape {
  int rows = 0, size = 0, bodyCount = 0, body[2] = {0, 0};  // bodies of the articulation
  bool moves[2] = {false, false};
  JointSeen seen = JointSeen::kByKind;
  bool pulls = false;   // its arms are known
  bool hasWay = false;  // its error is in m, else in rad
  bool isGap = false, hasLinear = false, hasAngular = false;
  bool stands = true;  // what it wants is a place, not a speed
  bool isWay = false;  // a force along a way, as a spring's
};
// Each file that includes this has its own.
static constexpr bool isLimit(const JointShape& shape) {
  return shape.seen == JointSeen::kCone || shape.seen == JointSeen::kTwist;
}
// A block below the diagonal: its row, its meeting, and where its numbers begin, which lie in the
// order in which they are solved with.
struct JointBelow {
  int to, block, at;
};
// Column i: below[start...], and of each pair p <= q of these the block that (q, p) goes to, -1 on
// the diagonal, at updates + q (q + 1) / 2 + p of `updates`; where it begins, of `updatesAt`.
struct JointColumn {
  int start = 0, count = 0, updates = 0;
};
// The bodies that the rows of a block share, by their places in the later and the earlier row.
struct JointMeeting {
  int count = 0, later[2] = {0, 0}, earlier[2] = {0, 0};
};

struct JointPair {  // of rows of the tail, by their places in it
  int later = 0, earlier = 0;
  JointMeeting meeting;
};

// Limits come last: they are solved for by what eliminating the other rows leaves of A, so that the
// factor stays while it is found which of them are at a bound. Triangles are by rows, of all rows
// of the tail; all but `a` is of those that are used, in the order of `places`.
template <int W>
struct JointTail {
  Num<W>*a, *factor, *free, *held, *x;
  char* gives;  // held since what is aimed at was eliminated
  int *places, *count;
  bool* isFactored;
  const JointPair* pairs;
  int pairCount;
};

template <int W>
struct JointView {
  JointBody<W>* bodies;
  JointLanes<W>* rows;
  JointFactor<W>* factors;     // of the rows
  JointFactored<W>* factored;  // of the bodies
  Num<W>*entries, *scaled;     // of blocks, by columns: A_ki below the diagonal, and L_ki
  int bodyCount, rowCount, tailStart;
  const JointShape* shapes;
  const JointColumn* columns;
  const JointBelow* below;
  const int* updates;
  const JointMeeting* meetings;
  Num<W>* open;                 // by lane: 0 where positions are as good as they get
  const Num<W>* stale;          // by lane: 1 where the factor is to be made anew
  char* used;                   // by row: free in any lane
  int *usedBelow, *usedCounts;  // places in a column of what is used, from the column's start
  JointTail<W> tail;
};

// What contacts move the bodies by, where they take turns with joints: of each lane, body after
// body, its slot, and how many lanes there are.
struct JointContacts {
  const int* slots;
  LaneMotion* motions;
  LaneStart* before;
  const LaneMass* masses;
  const char* moves;  // by body
  int lanes;
};

template <int W>
struct JointKernels {
  using System = JointView<W>;
  void (*place)(const System&);               // x, q: the start moved by u
  void (*turnBack)(const System&);            // q to backQ
  void (*seeGaps)(const System&, bool back);  // c of gaps at x, q, and J there or at x, backQ
  // c, J and bounds of cones and twists: of those used, or of all, where only the sign of c counts
  // unless they carried in the last substep.
  void (*seeLimits)(const System&, bool all);
  void (*begin)(const System&);  // lambda = 0 of what the kernels evaluate
  // Limits are free where lambda = 0 is no solution, and where they carried in the last substep.
  void (*chooseLimits)(const System&);
  // Of what the kernels evaluate: held where it gives way, and limits where they carry nothing.
  // Changed: free rows are others than the factor's, but for those of the tail, which leaves out
  // itself what is held.
  void (*keepCarrying)(const System&, bool (&changed)[W]);
  void (*stiffen)(const System&);                          // of bodies, by lambda of all that pulls
  void (*factorize)(const System&);                        // the lanes that are stale
  void (*findChanged)(const System&, bool (&changed)[W]);  // too much for the factor to serve
  void (*respond)(const System&);                          // M^-1 J^T alone
  void (*aimAtErrors)(const System&);  // right = -(c - left + J (u - seen) + alpha lambda)
  // Open from now on: what is aimed at is more than this part of the larger arm and the way, or
  // rad.
  bool (*findOpen)(const System&, double tolerance);
  void (*aimAtVelocities)(const System&);  // right = -J u
  // right <- A^-1 right; limits that would pass their bound are held there, to be so from `apply`
  // on
  void (*substitute)(const System&);
  // u, theta: what bodies would move by without joints -> what they do, for so little that no bound
  // is reached: `open` is 0.
  void (*follow)(const System&);
  void (*apply)(const System&);  // lambda += right, u += M^-1 J^T right
  // u and theta take what contacts have given since they last knew, and tell them what they are.
  void (*takeContacts)(const System&, const JointContacts&);
  void (*tellContacts)(const System&, const JointContacts&);
};

template <int W>
const JointKernels<W>& jointKernels();
extern const JointKernels<1> kJointKernelsSse2Of1, kJointKernelsAvx2Of1;
extern const JointKernels<4> kJointKernelsSse2Of4, kJointKernelsAvx2Of4;
extern const JointKernels<8> kJointKernelsAvx512Of8;
// How many articulations may lie side by side here: 8 where the processor has AVX-512, else 4.
int mostJointLanes();

// q = exp(theta) q of a turn that is too far for a few terms of the series.
void turnFar(const double (&theta)[3], double (&q)[4]);
// A unit vector normal to n.
void normalTo(const double (&n)[3], double (&w)[3]);

}  // namespace physics
