// Looks for the event between two frames that two runs came apart at.
#include "app/trust/event.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

using physics::BodyId;

bool touchesAt(const Track& track, int frame, const BodyPair& pair) {
  const std::vector<BodyPair>& touching = track.frames[frame].touching;
  return std::binary_search(touching.begin(), touching.end(), pair);
}

// From the frame before to this one.
bool changesAt(const Track& track, int frame, const BodyPair& pair, TrustEvent::Kind kind) {
  const bool before = touchesAt(track, frame - 1, pair), now = touchesAt(track, frame, pair);
  return kind == TrustEvent::Kind::kBegan ? !before && now : before && !now;
}

double velocityChange(const Track& track, int frame, BodyId body, double radius) {
  if (frame < 1 || frame >= track.frameCount()) return 0;
  return apart(track.frames[frame].velocities[body], track.frames[frame - 1].velocities[body],
               radius);
}

// Its velocity changes in this frame by much more than in those around it: it hit something that it
// has left again, or came to a limit.
bool joltsAt(const Track& track, int frame, BodyId body, double radius) {
  constexpr double kJump = 4;
  const double around = std::max(velocityChange(track, frame - 1, body, radius),
                                 velocityChange(track, frame + 1, body, radius));
  return velocityChange(track, frame, body, radius) > kJump * around;
}

class EventSearch {
 public:
  EventSearch(const Track& a, const Track& b, const std::vector<Allowed>& allowed, BodyId body)
      : a_(a), b_(b), allowed_(allowed), group_(allowed[body].group) {}

  void look(int frame) {
    for (const Track* track : {&a_, &b_}) {
      for (const int at : {frame, frame - 1}) {
        for (const BodyPair& pair : track->frames[at].touching) {
          if (!isOurs(pair.first) && !isOurs(pair.second)) continue;
          for (const auto kind : {TrustEvent::Kind::kBegan, TrustEvent::Kind::kEnded}) {
            take(kind, frame, pair, changesAt(a_, frame, pair, kind),
                 changesAt(b_, frame, pair, kind));
          }
        }
      }
    }
    for (BodyId body = 1; body < static_cast<BodyId>(allowed_.size()); ++body) {
      if (!isOurs(body)) continue;
      const double radius = allowed_[body].radius;
      take(TrustEvent::Kind::kJolt, frame, {body, 0}, joltsAt(a_, frame, body, radius),
           joltsAt(b_, frame, body, radius));
    }
  }
  std::optional<TrustEvent> best() const { return best_; }

 private:
  bool isOurs(BodyId body) const { return allowed_[body].moves && allowed_[body].group == group_; }
  double velocitiesApart(int frame, BodyId body) const {
    return apart(a_.frames[frame].velocities[body], b_.frames[frame].velocities[body],
                 allowed_[body].radius);
  }
  // By how much the velocities of ours came further apart.
  double opened(int frame, const BodyPair& pair) const {
    double most = 0;
    for (const BodyId body : {pair.first, pair.second}) {
      if (!isOurs(body)) continue;
      most = std::max(most, velocitiesApart(frame, body) - velocitiesApart(frame - 1, body));
    }
    return most;
  }
  // A contact is told before the jolt that it gives.
  void take(TrustEvent::Kind kind, int frame, const BodyPair& pair, bool inFirst, bool inSecond) {
    if (!inFirst && !inSecond) return;
    const double by = opened(frame, pair);
    if (!(by > most_)) return;
    most_ = by;
    best_ = TrustEvent{kind, frame, pair.first, pair.second, inFirst, inSecond};
  }

  const Track &a_, &b_;
  const std::vector<Allowed>& allowed_;
  const int group_;
  double most_ = 0;
  std::optional<TrustEvent> best_;
};

}  // namespace

Growth growthOf(const Track& a, const Track& b, BodyId body, const Allowed& allowed, int beyond) {
  constexpr double kBegins = 0.1;
  const auto distanceAt = [&](int frame) {
    return apart(a.frames[frame].poses[body], b.frames[frame].poses[body], allowed.radius);
  };
  Growth growth;
  growth.to = growth.from = beyond;
  growth.distance = distanceAt(beyond);
  while (growth.from > 0) {
    growth.fromDistance = distanceAt(--growth.from);
    if (growth.fromDistance <= kBegins * allowed.distance) break;
  }
  const double time = a.frames[beyond].time - a.frames[growth.from].time;
  if (time > 0 && growth.fromDistance > 0) {
    growth.rate = std::log(growth.distance / growth.fromDistance) / time;
  }
  return growth;
}

std::optional<TrustEvent> findEvent(const Track& a, const Track& b,
                                    const std::vector<Allowed>& allowed, BodyId body,
                                    const Growth& growth) {
  EventSearch search(a, b, allowed, body);
  for (int frame = std::max(1, growth.from); frame <= growth.to; ++frame) search.look(frame);
  return search.best();
}

}  // namespace app
