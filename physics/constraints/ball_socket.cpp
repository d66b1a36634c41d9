// Ball and socket, (60)-(73).
#include "physics/constraints/ball_socket.h"

#include "physics/constraints/between.h"

namespace physics {

void BallSocket::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  row.c = between(x.now, bodies, anchors);     // (71)
  gradientOfGap(x.now, bodies, anchors, row);  // (72)
}

}  // namespace physics
