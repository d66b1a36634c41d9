// A scene being simulated: the World, the names of its bodies, what is scripted, and its measures.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/world.h"
#include "physics/world/measure.h"
#include "scenes/scene.h"

namespace physics {
class Archive;
}

namespace scenes {

// What one frame measures; the columns of the metrics CSV.
struct FrameMetrics {
  int frame = 0;
  double time = 0;  // frame / fps
  double kinetic = 0, potential = 0, total = 0;
  physics::Vec3 linearMomentum = physics::Vec3::Zero(), angularMomentum = physics::Vec3::Zero();
  std::vector<physics::KindError> errors;
  double overlap = 0;
  double maxSpeed = 0;
  int contacts = 0;
  int iterations = 0;
  int asleep = 0;  // bodies
  int restarts = 0,
      fallbacks = 0;  // of second-order steppings, body by body; physics/model/report.h
  physics::AccuracyReport accuracy;
};

struct Moment;  // moment.h

class Simulation {
 public:
  explicit Simulation(const Scene& scene);  // throws InputError where the World refuses a value
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  // Threads that steps share, 1 at first: the same bytes for any number.
  void setThreads(int count);

  // Applies what is scripted (pose sequences, kinematic paths) and steps to the next frame.
  physics::StepReport advance();

  // Instead of advance(): the next frame as another program found it, by BodyId. False, and the
  // frame stays, where a number is not finite.
  bool place(std::span<const physics::Pose> poses, std::span<const physics::Velocity> velocities);

  // The present frame, to be shown again: instead of advance(), in any order, and by any Simulation
  // of the same scene. What is shown is seen and measured as it was, bit for bit, but cannot be
  // stepped from: how the state came about is forgotten. False, and the frame stays, where a number
  // is not finite or there are not as many as this scene has.
  Moment moment() const;
  bool show(const Moment& moment);

  // All that the next frame depends on, to a Simulation of the same scene: it goes on bit for bit.
  // Not of one that shows a Moment. A reader throws std::invalid_argument where the bytes are of
  // another scene, and is then not to be used any more.
  void archive(physics::Archive& a);

  int frame() const;
  bool isFinite() const;  // false once a step met a number that is not finite; the frame stays
  const Scene& scene() const;
  const physics::World& world() const;
  FrameMetrics metrics() const;
  std::uint64_t stateHash() const;
  std::vector<physics::ContactReport> contacts() const;
  std::vector<physics::ArmReport> arms() const;

  const std::string& bodyName(physics::BodyId body) const;
  physics::BodyId findBody(const std::string& name) const;  // -1: none
  // By its name, or by a second one such as "doll.head".
  bool isMeant(const Patterns& patterns, physics::BodyId body) const;

  struct Appearance;  // colours and meshes, for the view
  const Appearance& appearance() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Runs the scene's [[expect]] along a simulation: feed every frame from 0, then ask.
class Checker {
 public:
  explicit Checker(const Scene& scene);
  ~Checker();
  void observe(const Simulation& simulation);
  struct Failure {  // the first frame in which an expectation does not hold
    int frame = 0;
    double value = 0;
    std::string bodies, constraint;  // where; empty: nothing stands out
  };
  struct Verdict {
    Expectation expectation;
    double value = 0;  // the worst over its span
    double atTime = 0;
    bool holds = true;
    bool seen = true;            // false: no frame was in its span
    double least = 0, most = 0;  // over its span
    double bound = 0;            // what the value is held against
    bool atMost = true;          // from above, else from below
    std::string text;            // "joint_error 3.1e-07 m <= 1e-06 m"
    std::optional<Failure> failure;
  };
  std::vector<Verdict> verdicts() const;
  bool hasFailed() const;             // in a frame so far; no later frame can mend that
  void archive(physics::Archive& a);  // to a Checker of the same scene

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scenes
