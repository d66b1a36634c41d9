// Links of a model as [[body]]: what hangs together without a joint is one.
#include "scenes/models/write_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scenes {
namespace {

using physics::Pose;
using physics::Vec3;

bool moves(const ModelLink& link) { return link.free || !link.joints.empty(); }

Value shapeOf(const ModelPart& part, const Words& words) {
  Value inner = words.table(), shape = words.table();
  const char* word = "convex";
  if (!part.rows.empty()) {
    word = "heights";
    words.set(inner, "size",
              words.array({words.number(part.extent.x()), words.number(part.extent.y())}));
    Value rows = words.array({});
    for (const std::vector<double>& row : part.rows) rows.items.push_back(words.numbers(row));
    words.set(inner, "rows", std::move(rows));
  } else if (const auto* box = std::get_if<physics::Box>(&part.shape)) {
    word = "box";
    words.set(inner, "size", words.vector(box->size));
  } else if (const auto* sphere = std::get_if<physics::Sphere>(&part.shape)) {
    word = "sphere";
    words.set(inner, "radius", words.number(sphere->radius));
  } else if (const auto* capsule = std::get_if<physics::Capsule>(&part.shape)) {
    word = "capsule";
    words.set(inner, "radius", words.number(capsule->radius));
    words.set(inner, "length", words.number(capsule->length));
  } else if (const auto* cylinder = std::get_if<physics::Cylinder>(&part.shape)) {
    word = "cylinder";
    words.set(inner, "radius", words.number(cylinder->radius));
    words.set(inner, "length", words.number(cylinder->length));
  } else {
    words.set(inner, "points", words.vectors(part.points));
  }
  words.set(shape, word, std::move(inner));
  return shape;
}

void setPose(Value& table, const Pose& pose, const Words& words) {
  if (!pose.x.isZero(0)) words.set(table, "position", words.vector(pose.x));
  if (!pose.q.vec().isZero(0)) words.set(table, "quaternion", words.quaternion(pose.q));
}

void setColor(Value& table, const ModelPart& part, const Words& words) {
  if (!part.color) return;
  Value color = words.vector(*part.color);
  if (part.opacity < 1) color.items.push_back(words.number(part.opacity));
  words.set(table, "color", std::move(color));
}

std::string newName(Written& written, const std::string& wanted) {
  const int before = written.used[wanted]++;
  return before == 0 ? wanted : newName(written, fmt::format("{}.{}", wanted, before));
}

void writePlane(const ModelPart& part, const Pose& pose, Value& body, const Words& words) {
  const Vec3 normal = yUp((pose.q * std::get<physics::Plane>(part.shape).normal).eval());
  Value plane = words.table(), shape = words.table();
  words.set(plane, "normal", words.vector(normal));
  words.set(plane, "offset", words.number(normal.dot(yUp(pose.x))));
  words.set(shape, "plane", std::move(plane));
  words.set(body, "shape", std::move(shape));
}

// Shapes that do not move are a body each: they may be far from each other.
void writeStanding(Written& written, int link) {
  const ModelLink& own = written.model.links[static_cast<std::size_t>(link)];
  for (const ModelPart& part : own.parts) {
    const Words words{part.place};
    Value body = words.table();
    const std::string otherwise = link == kWorldLink ? "ground" : own.name;
    const std::string name = newName(written, part.name.empty() ? otherwise : part.name);
    words.set(body, "name", words.text(name));
    const Pose pose = written.pose[static_cast<std::size_t>(link)] * part.pose;
    if (std::holds_alternative<physics::Plane>(part.shape)) {
      writePlane(part, pose, body, words);
    } else {
      words.set(body, "shape", shapeOf(part, words));
      words.set(body, "fixed", words.boolean(true));
      setPose(body, yUp(pose), words);
    }
    if (part.friction) words.set(body, "friction", words.number(*part.friction));
    setColor(body, part, words);
    words.add(written.root, "body", std::move(body));
    written.names[static_cast<std::size_t>(link)].push_back(name);
    if (!part.collides()) {
      Value apart = words.table();
      words.set(apart, "body", words.text(name));
      words.add(written.root, "no_contact", std::move(apart));
    }
  }
}

void setInertial(Value& body, const ModelInertial& inertial, bool inShapes, const Words& words) {
  const PrincipalInertial axes = principal(inertial);
  words.set(body, "mass", words.number(inertial.mass));
  words.set(body, "inertia", words.vector(axes.moments));
  if (!inShapes) return;
  words.set(body, "centre_of_mass", words.vector(axes.frame.x));
  if (!axes.frame.q.vec().isZero(0)) {
    words.set(body, "inertia_axes", words.quaternion(axes.frame.q));
  }
}

// Which parts are bodies' shapes: those that touch, or all where none does.
std::vector<ModelPart> shapesOf(const ModelLink& link, ModelSurvey& survey) {
  std::vector<ModelPart> touching;
  for (const ModelPart& part : link.parts) {
    if (part.collides()) touching.push_back(part);
  }
  if (touching.empty()) return link.parts;
  for (const ModelPart& part : link.parts) {
    if (part.collides()) continue;
    survey.remark("not drawn: a shape that touches nothing, on a body with shapes that do",
                  part.place);
  }
  return touching;
}

void setFriction(Value& body, const std::vector<ModelPart>& parts, ModelSurvey& survey,
                 const Words& words) {
  if (parts.empty() || !parts[0].friction) return;
  words.set(body, "friction", words.number(*parts[0].friction));
  for (const ModelPart& part : parts) {
    if (part.friction == parts[0].friction) continue;
    survey.remark("a second friction on one body: that of its first shape counts", part.place);
  }
}

ModelInertial shared(ModelInertial inertial, double share) {
  inertial.mass *= share;
  inertial.inertia *= share;
  return inertial;
}

// The moments in the part's frame, where that is of the centre of mass and the principal axes.
std::optional<Vec3> momentsIn(const ModelPart& part, const ModelInertial& inertial) {
  const physics::Mat3 turn = part.pose.q.toRotationMatrix();
  const physics::Mat3 own = turn.transpose() * inertial.inertia * turn;
  const physics::Mat3 products = own - physics::Mat3(own.diagonal().asDiagonal());
  const bool centred = (inertial.centre - part.pose.x).norm() < 1e-9 && part.points.empty();
  if (!centred || products.norm() > 1e-12 * own.norm()) return std::nullopt;
  return own.diagonal().eval();
}

// By shapes whose masses sum to the link's, where they do; else with its inertia stated.
void setMatter(Value& body, const ModelLink& link, const std::vector<ModelPart>& parts,
               const ModelInertial& inertial, const Words& words) {
  const double own = inertialOf(link).mass, share = own > 0 ? inertial.mass / own : 0;
  const bool ofParts = !link.inertial && share > 0 && parts.size() == link.parts.size() &&
                       std::all_of(parts.begin(), parts.end(),
                                   [](const ModelPart& part) { return inertialOf(part).mass > 0; });
  const auto moments = parts.size() == 1 ? momentsIn(parts[0], inertial) : std::nullopt;
  if (parts.size() == 1 && (ofParts || moments)) {
    words.set(body, "shape", shapeOf(parts[0], words));
    words.set(body, "mass", words.number(inertial.mass));
    if (!ofParts) words.set(body, "inertia", words.vector(*moments));
    return;
  }
  Value shapes = words.array({});
  for (const ModelPart& part : parts) {
    const Words here{part.place};
    Value one = here.table();
    here.set(one, "shape", shapeOf(part, here));
    setPose(one, part.pose, here);
    if (ofParts) here.set(one, "mass", here.number(share * inertialOf(part).mass));
    setColor(one, part, here);
    shapes.items.push_back(std::move(one));
  }
  words.set(body, "shapes", std::move(shapes));
  if (!ofParts) setInertial(body, inertial, true, words);
}

// Of a link without one that others hang on, such as one between two joints: a ring's.
ModelInertial massOf(Written& written, int index) {
  const ModelLink& link = written.whole[static_cast<std::size_t>(index)];
  const ModelInertial own = inertialOf(link);
  if (own.mass > 0) return own;
  for (std::size_t k = static_cast<std::size_t>(index) + 1; k < written.whole.size(); ++k) {
    const auto parent = static_cast<std::size_t>(written.whole[k].parent);
    const bool next = written.carrier[k] == static_cast<int>(k) && written.carrier[parent] == index;
    const ModelInertial heavy = next ? massOf(written, static_cast<int>(k)) : ModelInertial{};
    if (!(heavy.mass > 0)) continue;
    written.survey.remark("a body without a mass gets a hundredth of that of the next", link.place);
    const double moment = kRingShare * principal(heavy).moments.maxCoeff();
    return {kRingShare * heavy.mass, Vec3::Zero(), moment * physics::Mat3::Identity()};
  }
  return own;
}

void writeMoving(Written& written, int index) {
  const auto k = static_cast<std::size_t>(index);
  const ModelLink& link = written.whole[k];
  const Words words{link.place};
  const std::size_t rings = std::max<std::size_t>(link.joints.size(), 1) - 1;
  const ModelInertial inertial =
      shared(massOf(written, index), 1 - kRingShare * static_cast<double>(rings));
  if (!(inertial.mass > 0)) {
    fail(written.survey.context(), link.place,
         fmt::format("body '{}' moves: expected a mass > 0, of its own or of its shapes",
                     link.name));
  }
  const std::vector<ModelPart> parts = shapesOf(link, written.survey);
  WrittenBody& out = written.bodies[k];
  out = {newName(written, link.name), written.pose[k]};
  Value body = words.table();
  words.set(body, "name", words.text(out.name));
  if (parts.empty()) {
    Value shape = words.table();
    words.set(shape, "point", words.table());
    words.set(body, "shape", std::move(shape));
    setInertial(body, inertial, false, words);
    out.frame = out.frame * principal(inertial).frame;
  } else {
    setMatter(body, link, parts, inertial, words);
    if (body.find("shape") != nullptr) out.frame = out.frame * parts[0].pose;
  }
  setPose(body, yUp(out.frame), words);
  setFriction(body, parts, written.survey, words);
  if (body.find("shape") != nullptr && !parts.empty()) setColor(body, parts[0], words);
  words.add(written.root, "body", std::move(body));
  written.names[k].push_back(out.name);
}

void carry(ModelLink& carrier, const ModelLink& link, const Pose& pose) {
  const bool stated = carrier.inertial || link.inertial;
  if (stated) {
    carrier.inertial = sum(inertialOf(carrier), moved(inertialOf(link), pose));
  }
  for (ModelPart part : link.parts) {
    part.pose = pose * part.pose;
    carrier.parts.push_back(std::move(part));
  }
}

}  // namespace

Vec3 yUp(const Vec3& v) { return {v.x(), v.z(), -v.y()}; }

Pose yUp(const Pose& pose) {
  const double half = std::sqrt(0.5);
  return {yUp(pose.x), physics::Quat(half, -half, 0, 0) * pose.q};
}

void findCarriers(Written& written) {
  const std::vector<ModelLink>& links = written.model.links;
  written.whole = links;
  written.names.resize(links.size());
  written.bodies.resize(links.size());
  std::vector<Pose> carried(links.size());  // in the carrier's frame
  for (std::size_t k = 0; k < links.size(); ++k) {
    const auto parent = static_cast<std::size_t>(links[k].parent);
    written.pose.push_back(k == 0 ? Pose{} : written.pose[parent] * links[k].pose);
    const bool own = k == 0 || moves(links[k]);
    written.carrier.push_back(own ? static_cast<int>(k) : written.carrier[parent]);
    if (own || written.carrier[k] == kWorldLink) continue;
    carried[k] = carried[parent] * links[k].pose;
    carry(written.whole[static_cast<std::size_t>(written.carrier[k])], links[k], carried[k]);
  }
}

// A field of heights is ground: it does not move.
void leaveOutMovingHeights(Written& written) {
  for (std::size_t k = 0; k < written.whole.size(); ++k) {
    if (written.carrier[k] == kWorldLink) continue;
    std::erase_if(written.whole[k].parts, [&](const ModelPart& part) {
      if (part.rows.empty()) return false;
      written.survey.leaveOut("<geom> of an <hfield> on a body that moves", part.place);
      return true;
    });
  }
}

void writeBodies(Written& written) {
  leaveOutMovingHeights(written);
  written.used["world"] = 1;
  for (int k = 0; k < static_cast<int>(written.whole.size()); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const int carrier = written.carrier[at];
    if (carrier == kWorldLink) {
      writeStanding(written, k);
      // Its points are written with Y up.
      written.bodies[at] = {"world", {Vec3::Zero(), yUp(Pose{}).q.conjugate()}};
    } else if (carrier == k) {
      writeMoving(written, k);
    } else {
      written.bodies[at] = written.bodies[static_cast<std::size_t>(carrier)];
    }
  }
}

}  // namespace scenes
