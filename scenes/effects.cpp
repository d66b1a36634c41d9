// The table of effects.
#include "scenes/effects.h"

#include <fmt/format.h>

#include <algorithm>

#include "physics/constraints/constraint_item.h"
#include "scenes/measure/survey.h"
#include "scenes/read/effect_words.h"
#include "scenes/read/settings_reader.h"

namespace scenes {
namespace {

using physics::Method;
using physics::Stepping;

std::string or_(const std::string& place, const char* otherwise) {
  return place.empty() ? otherwise : place;
}

// Why no body turns, whatever the scene says of it; empty where some do.
std::string whyNothingTurns(const Survey& s) {
  if (s.bodies.count == 0) return "no body can move";
  return s.turning.count == 0 ? "all bodies are points: no rotation" : "";
}

void fillGravity(const Survey& s, Effect& e) {
  e.on = s.scene.settings.gravity.has_value();
  e.why = or_(s.place("gravity"), "no [gravity]");
  e.count = s.bodies.count;
  e.unit = "bodies";
  e.without = {"gravity=none"};
}

// What turning bodies do; `whyNot`: nothing does. Empty: it is on.
void fillTurning(const Survey& s, const std::string& whyNot, const Made& made, Effect& e) {
  e.on = whyNot.empty();
  e.leftOut = !e.on;
  e.why = e.on ? s.place(made) : whyNot;
  e.count = made.count;
  e.unit = "bodies";
}

void fillRotation(const Survey& s, Effect& e) {
  fillTurning(s, whyNothingTurns(s), s.turning, e);
  e.stays = "a body with a shape can turn";
}

void fillGyroscopic(const Survey& s, Effect& e) {
  std::string whyNot = whyNothingTurns(s);
  if (whyNot.empty() && s.gyroscopic.count == 0) {
    whyNot = "inertia is isotropic: no gyroscopic torque";
  }
  fillTurning(s, whyNot, s.gyroscopic, e);
  e.stays = "it follows from the bodies' inertia";
}

void fillSpinning(const Survey& s, Effect& e) {
  const bool asked = s.scene.settings.spinInertia;
  e.leftOut = asked && s.gyroscopic.count == 0;
  e.on = asked && !e.leftOut;
  e.why = asked ? s.place("simulation.inertia") : "inertia = \"plain\"";
  if (e.leftOut) e.why = "no inertia changes with the orientation: M~ is M";
  e.count = s.gyroscopic.count;
  e.unit = "bodies";
  e.without = {"simulation.inertia=plain"};
}

void fillSecondOrder(const Survey& s, Effect& e) {
  const Stepping stepping = s.scene.settings.stepping;
  e.on = stepping == Stepping::kBdf2 || stepping == Stepping::kSymmetric;
  e.why = or_(s.place("simulation.stepping"), "stepping = \"paper\"");
  e.count = s.bodies.count;
  e.unit = "bodies";
  e.without = {"simulation.stepping=paper"};
}

void fillArms(const Survey& s, Effect& e) {
  e.on = s.arms.count > 0;
  e.why = e.on ? s.place(s.arms) : "no [[arm]]";
  e.count = s.arms.count;
  e.unit = "arms";
  e.stays = "the arm's bodies go where it puts them";
}

// Why nothing can touch; empty where something can.
std::string whyNoContact(const Survey& s) {
  const Value* enabled = s.find("contact.enabled");
  if (!s.scene.settings.contact) {
    return enabled != nullptr ? s.place("contact.enabled") + " = false"
                              : "no two bodies can touch: no [contact] and no plane";
  }
  if (s.pairs > 0 || (s.soft.count > 0 && s.shaped > 0)) return "";
  if (s.shaped == 0) return "no two bodies can touch: all are points";
  return "no two bodies can touch: all pairs are joined or fixed";
}

// The scene's words that switch contacts on.
std::string contactPlace(const Survey& s) {
  const std::string place = s.place("contact");
  if (!place.empty()) return place;
  for (const Member& word : s.tree.members) {
    for (const Value& element : word.value.items) {
      const Value* shape = element.find("shape");
      const bool isPlane = shape != nullptr && shape->find("plane") != nullptr;
      const bool isGround = shape != nullptr && (shape->find("triangles") != nullptr ||
                                                 shape->find("heights") != nullptr);
      const bool isRough = element.find("friction") != nullptr;
      if (!isPlane && !isGround && !isRough && element.find("restitution") == nullptr) continue;
      Made made;
      made.word = word.key;
      made.place = element.place;
      return s.place(made) + (isPlane    ? " is a plane"
                              : isGround ? " is ground"
                              : isRough  ? " has friction"
                                         : " has restitution");
    }
  }
  return "";
}

// `whyNot`: beyond that nothing touches; empty: it is on.
void fillOfContact(const Survey& s, const std::string& whyNot, const std::string& why, Effect& e) {
  const std::string none = whyNoContact(s);
  e.on = none.empty() && whyNot.empty();
  e.leftOut = s.scene.settings.contact && !e.on;
  e.why = e.on ? why : none.empty() ? whyNot : none;
  if (!e.on) return;
  e.count = s.pairs;
  e.unit = "pairs";
}

void fillBroadPhase(const Survey& s, Effect& e) {
  fillOfContact(s, s.pairs > 0 ? "" : "no two rigid bodies can touch", contactPlace(s), e);
  e.stays = "goes with contact";
}

void fillContact(const Survey& s, Effect& e) {
  fillBroadPhase(s, e);
  e.without = {"contact.enabled=false"};
  e.stays.clear();
}

void fillSoftContact(const Survey& s, Effect& e) {
  fillOfContact(s, s.soft.count > 0 ? "" : "no rope, cloth or soft body", s.place(s.soft), e);
  e.leftOut = e.leftOut && s.soft.count > 0;
  e.count = e.on ? s.soft.count : 0;
  e.unit = "points";
  e.stays = "goes with contact";
}

void fillFriction(const Survey& s, Effect& e) {
  const std::string place = s.place("contact.friction");
  fillOfContact(s, s.frictional ? "" : "friction 0" + (place.empty() ? "" : " (" + place + ")"),
                or_(place, "the default of [contact] friction"), e);
  e.without = withoutSurface(s, "friction");
}

void fillRestitution(const Survey& s, Effect& e) {
  const auto& contact = s.scene.settings.contact;
  const bool bounces = contact && s.built.world.bodies().mostRestitution > 0;
  const std::string ofAll = s.place("contact.restitution");
  fillOfContact(s, bounces ? "" : "restitution 0", or_(ofAll, "bodies have one of their own"), e);
  e.leftOut = e.leftOut && bounces;
  e.without = withoutSurface(s, "restitution");
}

void fillSpeculative(const Survey& s, Effect& e) {
  const auto& contact = s.scene.settings.contact;
  const bool looks = contact && contact->margin > 0;
  fillOfContact(s, looks ? "" : s.place("contact.margin") + " = 0",
                or_(s.place("contact.margin"), "gaps up to 0.02 m are watched: the default"), e);
  e.leftOut = e.leftOut && looks;
  e.without = {"contact.margin=0"};
}

void fillDirect(const Survey& s, Effect& e) {
  const Method chosen = s.scene.settings.method;
  const bool asked = chosen == Method::kDirect;
  std::int64_t equalities = 0;  // small steps: of joints, which have arms
  physics::forEachKind(physics::Kinds{}, [&](const auto& kind) {
    using Kind = std::decay_t<decltype(kind)>;
    const auto made = s.kinds.find(Kind::kWord);
    const bool counts = asked || physics::isAngular<typename Kind::Item>();
    if (made != s.kinds.end() && counts) equalities += made->second.equalities;
  });
  e.leftOut = asked && equalities == 0;
  e.on = (asked || s.scene.settings.takesSmallSteps()) && equalities > 0;
  const std::string method = fmt::format("method = \"{}\"", wordOf(chosen));
  e.why =
      e.leftOut ? "no joint to solve directly" : or_(s.place("simulation.method"), method.c_str());
  e.count = equalities;
  e.unit = "joints";
  e.without = {"simulation.method=nonlinear_gauss_seidel"};
}

void fillSleep(const Survey& s, Effect& e) {
  e.on = s.scene.settings.sleep.has_value() && s.bodies.count > 0;
  e.why = or_(s.place("sleep"), "no [sleep]");
  if (s.bodies.count == 0) e.why = "no body can move";
  e.count = s.bodies.count;
  e.unit = "bodies";
  e.without = {"sleep.enabled=false"};
}

void fillLocalSubsteps(const Survey& s, Effect& e) {
  const physics::Settings& settings = s.scene.settings;
  const bool isOwn = s.scene.settings.takesSmallSteps();
  e.leftOut = settings.localSubsteps && (isOwn || settings.substepCount() == 1);
  e.on = settings.localSubsteps && !e.leftOut;
  e.why = !e.leftOut ? or_(s.place("simulation.local_substeps"), "local_substeps = false")
          : isOwn    ? "by the default method islands choose without it"
                     : "one substep: no island can do with fewer";
  e.count = s.bodies.count;
  e.unit = "bodies";
  e.without = {"simulation.local_substeps=false"};
}

void fillShadows(const Survey& s, Effect& e) {
  e.on = s.scene.light.shadows;
  e.why = or_(s.place("light.shadows"), "dbd render draws them");
  e.stays = "of pictures, not of the step";
}

void fillHud(const Survey&, Effect& e) {
  e.why = "only with --hud";
  e.stays = "of pictures, not of the step";
}

void fillOverlays(const Survey& s, Effect& e) {
  const Overlays& o = s.scene.overlays;
  e.count = o.contacts + o.impulses + o.joints + o.centresOfMass + o.arms + o.armTargets +
            o.armAngles + o.armTips + o.armCentres + o.vectors;
  e.on = e.count > 0;
  e.unit = "kinds";
  e.why = or_(s.place("overlays"), "no [overlays], only with --overlays");
  e.stays = "of pictures, not of the step";
}

struct Row {
  const char* name;
  EffectPart part;
  void (*fill)(const Survey&, Effect&);
};

constexpr Row kMotion[] = {
    {"gravity", EffectPart::kMotion, fillGravity},
    {"rotation", EffectPart::kMotion, fillRotation},
    {"gyroscopic_torque", EffectPart::kMotion, fillGyroscopic},
    {"spinning_inertia", EffectPart::kMotion, fillSpinning},
    {"second_order", EffectPart::kMotion, fillSecondOrder},
    {"arm", EffectPart::kMotion, fillArms},
};
constexpr Row kRest[] = {
    {"broad_phase", EffectPart::kContacts, fillBroadPhase},
    {"narrow_phase", EffectPart::kContacts, fillBroadPhase},
    {"contact", EffectPart::kContacts, fillContact},
    {"soft_contact", EffectPart::kContacts, fillSoftContact},
    {"friction", EffectPart::kContacts, fillFriction},
    {"restitution", EffectPart::kContacts, fillRestitution},
    {"speculative_contact", EffectPart::kContacts, fillSpeculative},
    {"direct", EffectPart::kSolution, fillDirect},
    {"sleep", EffectPart::kSolution, fillSleep},
    {"local_substeps", EffectPart::kSolution, fillLocalSubsteps},
    {"shadows", EffectPart::kPictures, fillShadows},
    {"hud", EffectPart::kPictures, fillHud},
    {"overlays", EffectPart::kPictures, fillOverlays},
};

void add(const Survey& survey, const Row& row, std::vector<Effect>& effects) {
  Effect effect;
  effect.name = row.name;
  effect.part = row.part;
  row.fill(survey, effect);
  effects.push_back(std::move(effect));
}

// A kind of constraint or force, whichever there are.
void addKind(const Survey& s, const char* kind, EffectPart part, std::vector<Effect>& effects) {
  Effect effect;
  effect.name = kind;
  effect.part = part;
  const auto found = s.kinds.find(kind);
  effect.on = found != s.kinds.end();
  if (effect.on) {
    effect.why = s.place(found->second);
    effect.count = found->second.count;
    effect.rows = found->second.rows;
    takeOut(s, found->second, effect);
  } else {
    effect.why = whyNone(kind);
  }
  effects.push_back(std::move(effect));
}

}  // namespace

const char* nameOf(EffectPart part) {
  constexpr const char* kNames[] = {"motion",   "forces",   "constraints",
                                    "contacts", "solution", "pictures"};
  return kNames[static_cast<int>(part)];
}

std::vector<Effect> effectsOf(const Scene& scene) {
  const Survey survey(scene);
  std::vector<Effect> effects;
  for (const Row& row : kMotion) add(survey, row, effects);
  for (const EffectPart part : {EffectPart::kForces, EffectPart::kConstraints}) {
    physics::Kinds kinds;
    physics::forEachKind(kinds, [&](const auto& kind) {
      using Kind = std::decay_t<decltype(kind)>;
      const bool isForce = physics::Force<typename Kind::Item>;
      if (isForce == (part == EffectPart::kForces)) addKind(survey, Kind::kWord, part, effects);
    });
  }
  for (const Row& row : kRest) add(survey, row, effects);
  return effects;
}

std::vector<std::string> everythingOn() {
  return {"simulation.leave_out=false", "simulation.local_substeps=false", "sleep.enabled=false",
          "contact.enabled=true", "simulation.inertia=spinning"};
}

}  // namespace scenes
