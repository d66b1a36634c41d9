// A motion that was simulated once, in a file.
#include "app/run/motion.h"

#include <algorithm>
#include <cstring>

#include "app/base/build_info.h"
#include "physics/base/archive.h"
#include "physics/bodies/compound.h"
#include "physics/bodies/triangles.h"
#include "scenes/read/input_error.h"

namespace app {

namespace {

using scenes::MomentNumbers;

constexpr const char* kFormat = "dbd motion";
constexpr int kVersion = 1;

// Of what a motion is the motion of: names, start, masses and shapes, to the last bit.
class Fingerprint {
 public:
  std::string of(const scenes::Simulation& start) {
    const physics::Bodies& bodies = start.world().bodies();
    for (physics::BodyId b = 0; b < bodies.size(); ++b) {
      bytes_ += start.bodyName(b) + '\n';
      add(bodies.pose[b].x);
      add(bodies.pose[b].q.coeffs());
      add(bodies.mass[b]);
      add(bodies.inertia[b]);
      addAny(bodies.shape[b]);
    }
    return hashText(bytes_);
  }

 private:
  void add(double number) { bytes_.append(reinterpret_cast<const char*>(&number), sizeof number); }
  template <class Vector>
  void add(const Vector& vector) {
    for (int i = 0; i < vector.size(); ++i) add(vector[i]);
  }
  void addAny(const physics::Shape& any) {
    add(static_cast<double>(any.index()));
    std::visit([this](const auto& shape) { addShape(shape); }, any);
  }
  template <class Shape>
  void addShape(const Shape& shape) {
    if constexpr (requires { shape.size; }) add(shape.size);
    if constexpr (requires { shape.radius; }) add(shape.radius);
    if constexpr (requires { shape.length; }) add(shape.length);
    if constexpr (requires { shape.normal; }) add(shape.normal);
    if constexpr (requires { shape.offset; }) add(shape.offset);
    if constexpr (requires { shape.parts; }) {
      for (const physics::Part& part : shape.parts->list) {
        addAny(part.shape);
        add(part.pose.x);
        add(part.pose.q.coeffs());
      }
    }
    if constexpr (requires { shape.mesh; }) {
      for (const physics::Vec3& vertex : shape.mesh->vertices) add(vertex);
      for (const auto& face : shape.mesh->faces) {
        for (const int i : face.vertices) add(static_cast<double>(i));
      }
    }
    if constexpr (requires { shape.hull; }) {
      for (const physics::Vec3& vertex : shape.hull->vertices) add(vertex);
    }
  }

  std::string bytes_;
};

std::vector<std::string> namesOf(const scenes::Simulation& simulation) {
  std::vector<std::string> names;
  for (physics::BodyId b = 0; b < simulation.world().bodyCount(); ++b) {
    names.push_back(simulation.bodyName(b));
  }
  return names;
}

// Texts of one length, filled up with zeros.
void addTexts(NpzFile& file, const std::string& name, const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  const int array = file.add({name, "|S" + std::to_string(length), {texts.size()}});
  for (std::string text : texts) {
    text.resize(length, '\0');
    file.append(array, text.data(), 1);
  }
}

}  // namespace

Motion Motion::create(const std::filesystem::path& path, const scenes::Simulation& start,
                      int frames, Keep keep) {
  return fill(NpzFile::create(path), start, frames, keep);
}

Motion Motion::begin(const std::filesystem::path& path, const scenes::Simulation& start, int frames,
                     Keep keep) {
  return fill(NpzFile::begin(path), start, frames, keep);
}

Motion Motion::goOn(const std::filesystem::path& path, const scenes::Simulation& start, int frames,
                    Keep keep) {
  return fill(NpzFile::goOn(path), start, frames, keep);
}

void Motion::archive(physics::Archive& a) { a(file_, contacts_); }

Motion Motion::fill(NpzFile empty, const scenes::Simulation& start, int frames, Keep keep) {
  Motion motion(std::move(empty));
  motion.setStart(start);
  const MomentNumbers numbers = numbersOf(motion.like_);
  const auto f = static_cast<std::uint64_t>(frames);
  const std::uint64_t bodies = motion.like_.poses.size();
  NpzFile& file = motion.file_;
  motion.pose_ = file.add({"pose", "<f8", {f, bodies, MomentNumbers::kPose}});
  if (keep == Keep::kAll) {
    motion.velocity_ = file.add({"velocity", "<f8", {f, bodies, MomentNumbers::kVelocity}});
  }
  motion.hash_ = file.add({"state_hash", "<u8", {f}});
  motion.metrics_ = file.add({"metrics", "<f8", {f, numbers.metrics.size()}});
  if (!numbers.arms.empty()) motion.arms_ = file.add({"arms", "<f8", {f, numbers.arms.size()}});
  if (keep != Keep::kPoses) {
    motion.end_ = file.add({"contact_end", "<u8", {f}});
    motion.contact_ = file.add({"contact", "<f8", {NpzFile::kGrows, MomentNumbers::kContact}});
  }
  return motion;
}

void Motion::setStart(const scenes::Simulation& start) {
  like_ = start.moment();
  names_ = namesOf(start);
  bodies_ = Fingerprint().of(start);
  fps_ = start.scene().fps;
}

void Motion::append(const scenes::Moment& moment) {
  const MomentNumbers numbers = numbersOf(moment);
  if (contact_ >= 0) {
    const std::uint64_t count = numbers.contacts.size() / MomentNumbers::kContact;
    contacts_ += count;
    file_.append(contact_, numbers.contacts.data(), count);
    file_.append(end_, &contacts_, 1);
  }
  if (velocity_ >= 0) file_.append(velocity_, numbers.velocities.data(), 1);
  if (arms_ >= 0) file_.append(arms_, numbers.arms.data(), 1);
  file_.append(metrics_, numbers.metrics.data(), 1);
  file_.append(hash_, &moment.stateHash, 1);
  file_.append(pose_, numbers.poses.data(), 1);
}

void Motion::commit(Json about) {
  about_ = {{"format", kFormat}, {"version", kVersion}, {"bodies", bodies_}, {"fps", fps_}};
  about_.update(about);
  addTexts(file_, "names", names_);
  addTexts(file_, "metric_names", scenes::numberNames(like_.metrics));
  addTexts(file_, "about", {jsonText(about_)});
  file_.commit();
}

Motion Motion::open(const std::filesystem::path& path) {
  Motion motion(NpzFile::open(path));
  const int about = motion.file_.find("about");
  if (about >= 0 && motion.file_.array(about).type[0] == '|' && motion.file_.rows(about) == 1) {
    std::string text(motion.file_.array(about).rowBytes(), '\0');
    motion.file_.read(about, 0, 1, text.data());
    text.resize(std::strlen(text.c_str()));
    motion.about_ = tryParseJson(text);
  }
  if (!motion.about_.is_object() || motion.about_.value("format", "") != kFormat) {
    throw scenes::InputError(path.string() + ": it is no motion of `dbd simulate --motion`");
  }
  if (motion.about_.value("version", 0) != kVersion) {
    throw scenes::InputError(path.string() + ": a motion of another version of dbd");
  }
  motion.findArrays();
  return motion;
}

void Motion::findArrays() {
  pose_ = file_.find("pose");
  velocity_ = file_.find("velocity");
  hash_ = file_.find("state_hash");
  metrics_ = file_.find("metrics");
  arms_ = file_.find("arms");
  contact_ = file_.find("contact");
  end_ = file_.find("contact_end");
}

void Motion::fitTo(const scenes::Simulation& start) {
  setStart(start);
  if (about_.value("bodies", "") != bodies_ || about_.value("fps", 0) != start.scene().fps) {
    throw scenes::InputError(file_.path().string() +
                             ": the motion of other bodies, of another start or at another fps "
                             "than those of " +
                             start.scene().path);
  }
  requireShapes();
}

void Motion::requireShapes() const {
  const MomentNumbers numbers = numbersOf(like_);
  const std::uint64_t frames = pose_ < 0 ? 0 : file_.rows(pose_), bodies = like_.poses.size();
  const auto is = [&](int array, const char* type, const std::vector<std::uint64_t>& shape) {
    return array >= 0 && file_.array(array).type == type && file_.array(array).shape == shape;
  };
  const auto maybe = [&](int array, const char* type, const std::vector<std::uint64_t>& shape) {
    return array < 0 || is(array, type, shape);
  };
  const std::uint64_t contacts = contact_ < 0 ? 0 : file_.rows(contact_);
  const bool fits = frames > 0 && is(pose_, "<f8", {frames, bodies, MomentNumbers::kPose}) &&
                    maybe(velocity_, "<f8", {frames, bodies, MomentNumbers::kVelocity}) &&
                    is(hash_, "<u8", {frames}) &&
                    is(metrics_, "<f8", {frames, numbers.metrics.size()}) &&
                    (numbers.arms.empty() || is(arms_, "<f8", {frames, numbers.arms.size()})) &&
                    (contact_ < 0) == (end_ < 0) && maybe(end_, "<u8", {frames}) &&
                    maybe(contact_, "<f8", {contacts, MomentNumbers::kContact});
  if (fits) return;
  throw scenes::InputError(file_.path().string() + ": its arrays are not those of a motion");
}

std::vector<double> Motion::row(int array, int frame) const {
  if (array < 0) return {};
  std::vector<double> numbers(file_.array(array).rowBytes() / sizeof(double));
  file_.read(array, static_cast<std::uint64_t>(frame), 1, numbers.data());
  return numbers;
}

std::vector<double> Motion::contactsOf(int frame) const {
  if (contact_ < 0) return {};
  std::uint64_t first = 0, end = 0;
  const auto f = static_cast<std::uint64_t>(frame);
  file_.read(end_, f, 1, &end);
  if (frame > 0) file_.read(end_, f - 1, 1, &first);
  if (first > end) throw scenes::InputError(file_.path().string() + ": contact_end falls");
  if (first == end) return {};  // before the first one is written, its place is not in the file
  std::vector<double> numbers(MomentNumbers::kContact * (end - first));
  file_.read(contact_, first, end - first, numbers.data());
  return numbers;
}

scenes::Moment Motion::moment(int frame) const {
  MomentNumbers numbers;
  numbers.poses = row(pose_, frame);
  numbers.velocities = row(velocity_, frame);
  numbers.arms = row(arms_, frame);
  numbers.metrics = row(metrics_, frame);
  numbers.contacts = contactsOf(frame);
  scenes::Moment moment = momentFrom(numbers, like_);
  moment.frame = moment.metrics.frame = frame;
  moment.metrics.time = static_cast<double>(frame) / fps_;
  moment.stateHash = stateHash(frame);
  return moment;
}

std::uint64_t Motion::stateHash(int frame) const {
  std::uint64_t hash = 0;
  file_.read(hash_, static_cast<std::uint64_t>(frame), 1, &hash);
  return hash;
}

}  // namespace app
