// What trust came to: lines for people, a table, JSON.
#include <fmt/format.h>

#include <algorithm>

#include "app/base/csv.h"
#include "app/base/numbers.h"
#include "app/trust/trust.h"

namespace app {

namespace {

using physics::BodyId;

const std::string& nameOf(const Trust& trust, BodyId body) { return trust.track.names.at(body); }

double timeOf(const Trust& trust, int frame) { return trust.differences.at(frame).time; }

const char* runsText(const TrustEvent& event) {
  if (event.inFirst && event.inSecond) return "in both runs";
  return event.inFirst ? "in the run at its accuracy only" : "in the finer run only";
}

const char* wordOf(TrustEvent::Kind kind) {
  switch (kind) {
    case TrustEvent::Kind::kBegan:
      return "contact_began";
    case TrustEvent::Kind::kEnded:
      return "contact_ended";
    case TrustEvent::Kind::kJolt:
      break;
  }
  return "jolt";
}

std::string happeningText(const Trust& trust, const TrustEvent& event) {
  if (event.kind == TrustEvent::Kind::kJolt) {
    return fmt::format("'{}' is jolted, by a bounce or a limit", nameOf(trust, event.a));
  }
  return fmt::format("contact of '{}' and '{}' {}", nameOf(trust, event.a), nameOf(trust, event.b),
                     event.kind == TrustEvent::Kind::kBegan ? "begins" : "ends");
}

std::string finerText(const TrustPlan& plan) {
  std::string text = fmt::format("accuracy {:g}", plan.accuracy / 10);
  if (plan.every > 1) {
    text += fmt::format(" and {} fps (no accuracy steps {})", plan.finer.fps, plan.why);
  }
  return text;
}

Json bodiesJson(const Trust& trust) {
  Json bodies = Json::array();
  for (BodyId body = 1; body < static_cast<BodyId>(trust.allowed.size()); ++body) {
    const Allowed& allowed = trust.allowed[body];
    if (!allowed.moves) continue;
    const int at = trust.apartAt[body];
    bodies.push_back({{"name", nameOf(trust, body)},
                      {"size", allowed.size},
                      {"allowed", allowed.distance},
                      {"apart_at", at < 0 ? Json() : Json(timeOf(trust, at))}});
  }
  return bodies;
}

void addParting(const Trust& trust, Json& json) {
  const FrameDifference& first = trust.differences[trust.beyond];
  json["first_apart"] = {
      {"frame", trust.beyond},      {"time", first.time},       {"body", nameOf(trust, first.body)},
      {"distance", first.distance}, {"allowed", first.allowed}, {"bodies", first.beyond}};
  json["growth"] = {{"from", timeOf(trust, trust.growth.from)},
                    {"to", timeOf(trust, trust.growth.to)},
                    {"from_distance", trust.growth.fromDistance},
                    {"to_distance", trust.growth.distance},
                    {"rate", trust.growth.rate}};
  if (!trust.event) return;
  const TrustEvent& event = *trust.event;
  Json bodies = {nameOf(trust, event.a)};
  if (event.b > 0 || event.kind != TrustEvent::Kind::kJolt) {
    bodies.push_back(nameOf(trust, event.b));
  }
  json["event"] = {{"kind", wordOf(event.kind)},
                   {"frame", event.frame},
                   {"time", timeOf(trust, event.frame)},
                   {"bodies", bodies},
                   {"at_accuracy", event.inFirst},
                   {"finer", event.inSecond},
                   {"text", eventText(trust)}};
}

}  // namespace

std::string eventText(const Trust& trust) {
  const Growth& growth = trust.growth;
  const double passed = timeOf(trust, growth.to) - timeOf(trust, growth.from);
  if (!trust.event) {
    return fmt::format("no contact: it grows by itself, from {} to {} in {:.3g} s (rate {:.3g}/s)",
                       lengthText(growth.fromDistance), lengthText(growth.distance), passed,
                       growth.rate);
  }
  return fmt::format("{} at t = {:.3f} s, {}", happeningText(trust, *trust.event),
                     timeOf(trust, trust.event->frame), runsText(*trust.event));
}

std::string partingText(const Trust& trust) {
  const FrameDifference& first = trust.differences[trust.beyond];
  std::string text =
      fmt::format("body '{}' at t = {:.3f} s, {} of {} allowed", nameOf(trust, first.body),
                  first.time, lengthText(first.distance), lengthText(first.allowed));
  if (first.beyond > 1) text += fmt::format("; {} bodies in that frame", first.beyond);
  return text;
}

std::string trustText(const Trust& trust) {
  const TrustPlan& plan = trust.plan;
  std::string text =
      fmt::format("{}: accuracy {:g}{}, compared with {}\n", plan.scene.name, plan.accuracy,
                  plan.chosen ? " (the scene states none)" : "", finerText(plan));
  if (trust.differences.empty()) return text;
  const double last = trust.differences.back().time;
  if (trust.isWhole()) {
    const auto worst = std::max_element(
        trust.differences.begin(), trust.differences.end(),
        [](const auto& one, const auto& other) { return one.ratio() < other.ratio(); });
    text += fmt::format("trusted to the end, t = {:.2f} s\n", last);
    if (worst->body == 0) return text + "nothing in it can move\n";
    if (!(worst->distance > 0)) return text + "the two are the same to the last bit\n";
    return text + fmt::format("furthest apart: body '{}' at t = {:.3f} s, {} of {} allowed\n",
                              nameOf(trust, worst->body), worst->time, lengthText(worst->distance),
                              lengthText(worst->allowed));
  }
  text += fmt::format("trusted until t = {:.2f} s of {:g}\n", trust.until(), last);
  text += fmt::format("first apart: {}\n", partingText(trust));
  return text + fmt::format("event: {}\n", eventText(trust));
}

std::string trustCsv(const Trust& trust) {
  std::string table = "frame,time,body,distance,allowed,ratio,bodies_beyond,first_apart_distance\n";
  const BodyId followed = trust.isWhole() ? 0 : trust.differences[trust.beyond].body;
  for (int f = 0; f < trust.frames(); ++f) {
    const FrameDifference& d = trust.differences[f];
    const double distance = followed == 0 ? 0
                                          : apart(trust.track.frames[f].poses[followed],
                                                  trust.finer.frames[f].poses[followed],
                                                  trust.allowed[followed].radius);
    table += fmt::format("{},{:.17g},{},{:.9g},{:.9g},{:.9g},{},{:.9g}\n", f, d.time,
                         csvText(nameOf(trust, d.body)), d.distance, d.allowed, d.ratio(), d.beyond,
                         distance);
  }
  return table;
}

Json trustJson(const Trust& trust) {
  const TrustPlan& plan = trust.plan;
  Json json = {
      {"version", 1},
      {"scene",
       {{"name", plan.scene.name}, {"path", plan.scene.path}, {"overrides", plan.scene.overrides}}},
      {"accuracy", plan.accuracy},
      {"accuracy_chosen", plan.chosen},
      {"finer",
       {{"accuracy", plan.accuracy / 10}, {"fps", plan.finer.fps}, {"because_of", plan.why}}},
      {"duration", plan.scene.duration},
      {"trusted_until", trust.until()},
      {"whole", trust.isWhole()},
      {"first_apart", Json()},
      {"growth", Json()},
      {"event", Json()}};
  if (!trust.isWhole()) addParting(trust, json);
  json["bodies"] = bodiesJson(trust);
  return json;
}

}  // namespace app
