// The default method: small steps, each a position stage and a velocity stage over the same rows.
//
// A step looks for contacts, divides what moves into islands, and takes each through as many
// substeps of h as its load asks for. A substep is
//   predict      u = h v + h^2 M^-1 f
//   positions    joints as one block, contacts once (soft, as stiff as h resolves), joints again
//                ropes at once, of cloth its links at once and the rest swept, soft bodies
//                swept, with the contacts of their points
//   displace     X <- X + u
//   velocities   the same rows with no error to take back: joints, contacts and friction, joints
// From v0 the velocities change the kinetic energy by f(lambda) = lambda^T J v0 + lambda^T A
// lambda/2, which projected Gauss-Seidel goes down on: what moves a body without being motion, the
// taking back of overlaps and gaps, does not become speed. An island of one body that nothing holds
// flies on, exactly.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "physics/model/model.h"
#include "physics/solver/kept_contact.h"

namespace physics {

class Archive;
class SmallSteps {
 public:
  SmallSteps();
  ~SmallSteps();
  SmallSteps(SmallSteps&&) noexcept;
  SmallSteps& operator=(SmallSteps&&) noexcept;

  // `wake` makes those step that Sleep::called names.
  void step(Model& model, const std::function<void()>& wake, StepReport& report);

  std::vector<KeptContact>& contacts();
  const std::vector<KeptContact>& contacts() const;
  std::vector<KeptContact> sleeping;  // contacts of bodies that sleep; sorted
  int substepsOf(BodyId body) const;  // in the last step
  void forget();                      // multipliers and contacts: the state came from elsewhere
  void topologyChanged();
  std::size_t bytes() const;
  void archive(Archive& a, Model& model);  // the model's own comes before

 private:
  struct Batch;
  struct Trial;
  static void clear(Batch& batch);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace physics
