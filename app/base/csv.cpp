// The trajectory and metrics tables.
#include "app/base/csv.h"

#include <fmt/format.h>

#include <algorithm>

#include "physics/base/archive.h"

namespace app {

namespace {

std::vector<std::string> constraintKinds(const std::vector<scenes::FrameMetrics>& metrics) {
  std::vector<std::string> kinds;
  for (const scenes::FrameMetrics& frame : metrics) {
    for (const physics::KindError& error : frame.errors) {
      if (std::find(kinds.begin(), kinds.end(), error.kind) == kinds.end())
        kinds.push_back(error.kind);
    }
  }
  return kinds;
}

double errorOf(const scenes::FrameMetrics& frame, const std::string& kind) {
  for (const physics::KindError& error : frame.errors) {
    if (error.kind == kind) return error.largest;
  }
  return 0;
}

}  // namespace

void archive(physics::Archive& a, StageSeconds& seconds) {
  auto& [simulate, view, draw, write] = seconds;
  a(simulate, view, draw, write);
}

std::string csvText(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += c;
    result += c;
  }
  return result + '"';
}

std::string trajectoryHeader() { return "frame,time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n"; }

std::string trajectoryRows(const scenes::Simulation& of, int frame,
                           std::span<const physics::Pose> poses,
                           std::span<const physics::Velocity> velocities) {
  const double time = static_cast<double>(frame) / of.scene().fps;
  const std::string start = fmt::format("{},{:.17g},", frame, time);
  std::string rows;
  for (physics::BodyId body = physics::kWorldBody + 1; body < std::ssize(poses); ++body) {
    const physics::Vec3 x = poses[body].x;
    const physics::Quat q = poses[body].q;
    const physics::Velocity& velocity = velocities[body];
    const double values[] = {x.x(),          x.y(),          x.z(),          q.w(),
                             q.x(),          q.y(),          q.z(),          velocity.v.x(),
                             velocity.v.y(), velocity.v.z(), velocity.w.x(), velocity.w.y(),
                             velocity.w.z()};
    rows += start;
    rows += csvText(of.bodyName(body));
    for (const double value : values) rows += fmt::format(",{:.17g}", value);
    rows += '\n';
  }
  return rows;
}

std::string metricsTable(const std::vector<scenes::FrameMetrics>& metrics,
                         const std::vector<StageSeconds>& seconds) {
  const std::vector<std::string> kinds = constraintKinds(metrics);
  std::string table = "frame,time,kinetic,potential,total,px,py,pz,lx,ly,lz";
  for (const std::string& kind : kinds) table += "," + kind + "_error";
  table += ",overlap,contacts,iterations,restarts,fallbacks";
  table += ",simulate_seconds,view_seconds,draw_seconds,write_seconds,asleep";
  table += ",accepted_steps,rejected_steps,order,shortest_step,error_estimate\n";
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const scenes::FrameMetrics& m = metrics[i];
    const physics::Vec3 p = m.linearMomentum, l = m.angularMomentum;
    table += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g}", m.frame, m.time, m.kinetic,
                         m.potential, m.total);
    for (const double value : {p.x(), p.y(), p.z(), l.x(), l.y(), l.z()}) {
      table += fmt::format(",{:.17g}", value);
    }
    for (const std::string& kind : kinds) table += fmt::format(",{:.17g}", errorOf(m, kind));
    const StageSeconds& s = seconds[i];
    table += fmt::format(",{:.17g},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{}", m.overlap,
                         m.contacts, m.iterations, m.restarts, m.fallbacks, s.simulate, s.view,
                         s.draw, s.write, m.asleep);
    const physics::AccuracyReport& a = m.accuracy;
    table += fmt::format(",{},{},{},{:.6g},{:.6g}\n", a.accepted, a.rejected, a.order, a.least,
                         a.estimate);
  }
  return table;
}

}  // namespace app
