// Ball and socket, (60)-(73).
#include "physics/constraints/ball_socket.h"

namespace physics {

void BallSocket::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Pose &i = x.now[bodies[0]], &j = x.now[bodies[1]];
  const Vec3 ri = i.q * anchors[0], rj = j.q * anchors[1];
  row.c = (i.x + ri) - (j.x + rj);  // (71)
  row.linear[0].setIdentity();      // (72)
  row.linear[1] = -Mat3::Identity();
  row.angular[0] = -skew(ri);
  row.angular[1] = skew(rj);
}

}  // namespace physics
