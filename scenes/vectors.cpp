// Strokes first, then the letters, which keep off them.
#include "scenes/vectors.h"

#include <cmath>

#include "physics/constraints/ball_socket.h"
#include "scenes/read/recipe.h"
#include "scenes/view/label_placer.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Vec3;
using render::Color;
using Wish = LabelPlacer::Wish;

const Color kInk{0.10f, 0.10f, 0.11f, 1}, kErrorInk{0.78f, 0.18f, 0.08f, 1},
    kNormal{0.05f, 0.42f, 0.30f, 1}, kAngle{0.48f, 0.18f, 0.50f, 1};
constexpr size_t kMostLettered = 2;  // joints and contacts that still get letters
// Pixels at 720 lines before `ink`.
constexpr float kStroke = 2.6f, kThin = 1.8f, kPoint = 9, kLetters = 25;
constexpr double kAxisLength = 0.62, kArcRadius = 0.4, kNormalLength = 0.3;  // of the scene's size
constexpr float kConeOpacity = 0.22f;

class Sketch {
 public:
  Sketch(const Simulation& simulation, double scale, const ViewOptions& options,
         render::Picture& picture)
      : simulation_(simulation),
        scale_(scale),
        ink_(static_cast<float>(options.ink)),
        stampLetters_(options.stampLetters),
        picture_(picture),
        placer_(picture.camera, options.aspect) {}

  void draw() {
    const auto joints = simulation_.world().joints();
    const auto contacts = simulation_.contacts();
    lettered_ = joints.size() + contacts.size() <= kMostLettered;
    for (const physics::JointReport& joint : joints) {
      if (joint.axis.norm() > 0.5 && joint.axisB.norm() > 0.5) {
        drawAngle(joint, originOf(joint, joints));
      } else if (joint.kind == physics::BallSocketDef::kWord) {
        drawPoints(joint.a, joint.b, joint.pointA, joint.pointB);
      }
    }
    for (const physics::ContactReport& contact : contacts) drawContact(contact);
    const auto volumes = simulation_.world().volumes();
    if (volumes.size() == 1) drawVolume(volumes[0]);
    placer_.avoid(picture_);
    if (!lettered_) return;
    const float size = kLetters * ink_;
    if (stampLetters_ > 0) {
      placer_.avoidUpperLeft((0.5f + 0.5f * static_cast<float>(stampLetters_)) * size, 1.5f * size);
    }
    for (const Wish& wish : wishes_) placer_.put(wish, size, picture_);
  }

 private:
  // Dark enough to be read on white and on the body itself.
  Color inkOf(BodyId body) const {
    Color color = simulation_.appearance().colors[body];
    color.head<3>() *= 0.55f;
    color.w() = 1;
    return color;
  }
  bool hasCentre(BodyId body) const {
    return body != physics::kWorldBody &&
           !std::holds_alternative<physics::Plane>(simulation_.world().bodies().shape[body]);
  }
  Vec3 centreOf(BodyId body) const { return simulation_.world().bodies().pose[body].x; }

  void line(const Vec3& from, const Vec3& to, const Color& color, float width, bool arrow) {
    picture_.lines.push_back(
        {from.cast<float>(), to.cast<float>(), color, width * ink_, arrow, true});
  }
  void dot(const Vec3& at, const Color& color) {
    picture_.dots.push_back({at.cast<float>(), color, kPoint * ink_});
  }
  void letter(const Vec3& at, const LabelPlacer::Pixel& toward, const std::string& text,
              const Color& color) {
    wishes_.push_back({at.cast<float>(), toward, text, color});
  }
  // Beside the middle of an arrow, on its left as it is seen.
  void letterBeside(const Vec3& from, const Vec3& to, const std::string& text, const Color& color) {
    const LabelPlacer::Pixel along =
        placer_.project(to.cast<float>()) - placer_.project(from.cast<float>());
    letter(0.5 * (from + to), {along.y(), -along.x()}, text, color);
  }
  // Away from another place, as it is seen.
  void letterAway(const Vec3& at, const Vec3& other, const std::string& text, const Color& color) {
    const LabelPlacer::Pixel away =
        placer_.project(at.cast<float>()) - placer_.project(other.cast<float>());
    letter(at, away.norm() > 1 ? away : LabelPlacer::Pixel(0, -1), text, color);
  }

  void drawLever(BodyId body, const Vec3& p, const char* index) {
    if (!hasCentre(body)) return;
    const Vec3 x = centreOf(body);
    line(x, p, inkOf(body), kStroke, true);
    dot(x, kInk);
    letterAway(x, p, std::string("*x*_{") + index + "}", kInk);
    letterBeside(x, p, std::string("*r*_{") + index + "}", inkOf(body));
  }

  void drawPoints(BodyId a, BodyId b, const Vec3& pA, const Vec3& pB) {
    drawLever(a, pA, "i");
    drawLever(b, pB, "j");
    const bool open = (pA - pB).norm() > 0.01 * scale_;
    if (open) line(pB, pA, kErrorInk, kStroke, true);
    dot(pA, inkOf(a));
    if (!open) return letter(pA, {0, -1}, "*p*_{i} = *p*_{j}", kInk);
    dot(pB, inkOf(b));
    letterAway(pA, pB, "*p*_{i}", inkOf(a));
    letterAway(pB, pA, "*p*_{j}", inkOf(b));
    letterBeside(pB, pA, "δ*p*", kErrorInk);
  }

  // The edges, the points, and where the constraint would push each of them.
  void drawVolume(const physics::VolumeReport& volume) {
    constexpr const char* kIndex[] = {"0", "1", "2", "3"};
    Vec3 middle = Vec3::Zero();
    double largest = 0;
    for (int k = 0; k < 4; ++k) {
      middle += 0.25 * centreOf(volume.bodies[k]);
      largest = std::max(largest, volume.gradient[k].norm());
    }
    for (int k = 0; k < 4; ++k) {
      const Vec3 x = centreOf(volume.bodies[k]);
      for (int l = 0; l < k; ++l) line(x, centreOf(volume.bodies[l]), kInk, kThin, false);
      const Vec3 tip = x + kNormalLength * scale_ / largest * volume.gradient[k];
      line(x, tip, kNormal, kStroke, true);
      dot(x, kInk);
      letterAway(tip, x, std::string("*A*_{") + kIndex[k] + "}", kNormal);
      letterAway(x, middle + 0.5 * (x - tip), std::string("*x*_{") + kIndex[k] + "}", kInk);
    }
  }

  // The normal stands beside the points: along it lies their difference.
  void drawContact(const physics::ContactReport& contact) {
    const Vec3 foot = contact.point - contact.gap * contact.normal;
    drawPoints(contact.a, contact.b, contact.point, foot);
    const render::Camera& camera = picture_.camera;
    const Vec3 ahead = (camera.target - camera.eye).cast<double>();
    Vec3 aside = ahead.cross(contact.normal);
    if (aside.norm() < 1e-9) aside = Vec3::UnitX();  // seen from above: any side will do
    aside.normalize();
    const bool towardCentre = hasCentre(contact.b) && aside.dot(centreOf(contact.b) - foot) > 0;
    const Vec3 start = foot + (towardCentre ? -0.25 : 0.25) * scale_ * aside;
    const Vec3 tip = start + kNormalLength * scale_ * contact.normal;
    line(start, tip, kNormal, kStroke, true);
    letterAway(tip, start, "*n*", kNormal);
  }

  // Where a ball and socket joins the same bodies, else between their centres.
  Vec3 originOf(const physics::JointReport& joint,
                const std::vector<physics::JointReport>& joints) const {
    for (const physics::JointReport& other : joints) {
      const bool same = other.a == joint.a && other.b == joint.b;
      if (same && other.kind == physics::BallSocketDef::kWord) return other.pointA;
    }
    if (!hasCentre(joint.a)) return centreOf(joint.b);
    if (!hasCentre(joint.b)) return centreOf(joint.a);
    return 0.5 * (centreOf(joint.a) + centreOf(joint.b));
  }

  void drawAngle(const physics::JointReport& joint, const Vec3& origin) {
    const Vec3 tipI = origin + kAxisLength * scale_ * joint.axis;
    const Vec3 tipJ = origin + kAxisLength * scale_ * joint.axisB;
    if (joint.cone > 0) drawCone(origin, joint.axis, joint.cone, inkOf(joint.a));
    line(origin, tipI, inkOf(joint.a), kStroke, true);
    line(origin, tipJ, inkOf(joint.b), kStroke, true);
    const Vec3 w = joint.axis.cross(joint.axisB);
    const double angle = std::atan2(w.norm(), joint.axis.dot(joint.axisB));
    constexpr double kClosed = 0.02;  // rad: too little to be drawn
    if (angle < kClosed || w.norm() < 1e-9) {
      dot(origin, kInk);
      const Vec3 beside = 0.9 * tipI + 0.1 * origin;
      return letterBeside(beside, beside + (tipI - origin) * 0.01, "*n*_{i} = *n*_{j}", kInk);
    }
    letterAway(tipI, tipJ, "*n*_{i}", inkOf(joint.a));
    letterAway(tipJ, tipI, "*n*_{j}", inkOf(joint.b));
    drawArc(origin, joint.axis, w.normalized(), angle);
    const Vec3 tip = origin + 0.6 * kAxisLength * scale_ * w.normalized();
    line(origin, tip, kAngle, kThin, true);
    letterAway(tip, origin, "*w*", kAngle);
    dot(origin, kInk);
  }

  // Of the directions at this angle from the axis, as long as the axes are drawn, and its rim.
  void drawCone(const Vec3& apex, const Vec3& axis, double angle, const Color& ink) {
    constexpr int kPieces = 64;
    const Vec3 aside = axis.unitOrthogonal();
    const auto rim = [&](int i) -> Vec3 {
      const Eigen::AngleAxisd round(2 * M_PI * i / kPieces, axis);
      const Vec3 along = std::cos(angle) * axis + std::sin(angle) * (round * aside);
      return apex + kAxisLength * scale_ * along;
    };
    render::Surface cone;
    for (int i = 0; i < kPieces; ++i) {
      const auto first = static_cast<std::uint32_t>(cone.positions.size());
      for (const Vec3& corner : {apex, rim(i), rim(i + 1)}) {
        cone.positions.push_back(corner.cast<float>());
      }
      cone.indices.insert(cone.indices.end(), {first, first + 1, first + 2});
      line(rim(i), rim(i + 1), ink, kThin, false);
    }
    cone.color = cone.backColor = {ink.x(), ink.y(), ink.z(), kConeOpacity};
    picture_.surfaces.push_back(std::move(cone));
  }

  // From n_i to n_j about w, with a head at its end.
  void drawArc(const Vec3& origin, const Vec3& start, const Vec3& about, double angle) {
    constexpr int kPieces = 32;
    const auto at = [&](double share) -> Vec3 {
      return origin + kArcRadius * scale_ * (Eigen::AngleAxisd(share * angle, about) * start);
    };
    constexpr int kHead = 3;  // pieces that the arrow's head is long
    for (int i = 0; i < kPieces - kHead; ++i) {
      line(at(1.0 * i / kPieces), at((i + 1.0) / kPieces), kAngle, kThin, false);
    }
    line(at(1.0 - 1.0 * kHead / kPieces), at(1), kAngle, kThin, true);
    letterAway(at(0.5), origin, "*φ*", kAngle);
  }

  const Simulation& simulation_;
  const double scale_;
  const float ink_;
  const int stampLetters_;
  render::Picture& picture_;
  LabelPlacer placer_;
  bool lettered_ = true;
  std::vector<Wish> wishes_;
};

}  // namespace

void drawVectors(const Simulation& simulation, double scale, const ViewOptions& options,
                 render::Picture& picture) {
  Sketch(simulation, scale, options, picture).draw();
}

}  // namespace scenes
