// A motion that was simulated once, frame by frame in a file that NumPy reads: what pictures are
// drawn from, again and again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "app/base/npz.h"
#include "scenes/moment.h"

namespace app {

// The arrays, F frames and B bodies (0 is the world itself):
//   pose        <f8 F B 7    x y z [m], qw qx qy qz
//   velocity    <f8 F B 6    v [m/s], w [rad/s], world frame; may be absent
//   state_hash  <u8 F        as in run.json
//   metrics     <f8 F M      scenes::FrameMetrics, as metric_names says
//   arms        <f8 F A      physics::ArmReport, one after the other; absent without arms
//   contact     <f8 C 12     a b, point, normal from b to a, gap, impulse on a; may be absent
//   contact_end <u8 F        how many rows of `contact` there are up to the end of the frame
//   names       |S  B        metric_names |S M
//   about       |S  1        JSON: format, version, fps, and what run.json says of the run
// Motions of one version hold at least these; a reader of a later version reads them too.
class Motion {
 public:
  enum class Keep { kPoses, kContacts, kAll };  // contacts: and poses; all: and velocities

  // For up to `frames` frames of what begins as `start`. Nothing is left without commit().
  static Motion create(const std::filesystem::path& path, const scenes::Simulation& start,
                       int frames, Keep keep);
  // The same, but without commit() it stays for goOn() of the same.
  static Motion begin(const std::filesystem::path& path, const scenes::Simulation& start,
                      int frames, Keep keep);
  // After `archive` has read how much of it there is.
  static Motion goOn(const std::filesystem::path& path, const scenes::Simulation& start, int frames,
                     Keep keep);
  void archive(physics::Archive& a);
  // Throws InputError where it is no whole motion.
  static Motion open(const std::filesystem::path& path);

  // Throws InputError where the file holds other bodies than those that begin as `start`.
  void fitTo(const scenes::Simulation& start);

  void append(const scenes::Moment& moment);
  void commit(Json about);

  int frames() const { return static_cast<int>(file_.rows(pose_)); }
  bool hasContacts() const { return contact_ >= 0; }
  const Json& about() const { return about_; }

  // By processes that inherited this, of any frame that was there when they were asked for it.
  scenes::Moment moment(int frame) const;
  std::uint64_t stateHash(int frame) const;

 private:
  explicit Motion(NpzFile file) : file_(std::move(file)) {}
  static Motion fill(NpzFile file, const scenes::Simulation& start, int frames, Keep keep);
  void findArrays();
  void requireShapes() const;
  void setStart(const scenes::Simulation& start);
  std::vector<double> row(int array, int frame) const;
  std::vector<double> contactsOf(int frame) const;

  NpzFile file_;
  scenes::Moment like_;  // the start
  std::vector<std::string> names_;
  std::string bodies_;  // a hash of what moves
  int pose_ = -1, velocity_ = -1, hash_ = -1, metrics_ = -1, arms_ = -1, contact_ = -1, end_ = -1;
  std::uint64_t contacts_ = 0;  // written so far
  int fps_ = 1;
  Json about_;
};

}  // namespace app
