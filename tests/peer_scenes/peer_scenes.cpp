// SPDX-License-Identifier: BSD-3-Clause
#include "peer_scenes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "vps_bullet/shape.h"
#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/run/simulate.h"

namespace vps::peers {

namespace {

/// A body that moves: its mass, and its states over time.
struct Body {
  bullet::BodyFrame frame;
  std::vector<Pose> X_WB;  ///< pose of the body frame after each step
  std::vector<Twist> V_W;  ///< of the centre of mass
};

struct Run {
  double dt_s = 0;
  Vec3 gravity_W = Vec3::Zero();
  std::vector<Body> bodies;
  std::vector<double> energy_J;  ///< kinetic and potential energy after each step

  [[nodiscard]] double kineticEnergy_J(std::size_t step) const {
    double sum_J = 0;
    for (const Body& body : bodies) {
      const Vec3 w_B = body.X_WB[step].R.transpose() * body.V_W[step].w;
      sum_J += 0.5 * body.frame.mass_kg * body.V_W[step].v.squaredNorm() +
               0.5 * w_B.cwiseAbs2().dot(body.frame.inertia_kg_m2);
    }
    return sum_J;
  }
  [[nodiscard]] double energyAt_J(std::size_t step) const {
    double sum_J = kineticEnergy_J(step);
    for (const Body& body : bodies) sum_J -= body.frame.mass_kg * gravity_W.dot(body.X_WB[step].p);
    return sum_J;
  }
};

std::string text(const char* format, auto... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

struct Outcome {
  bool happens = false;
  std::string found;
};

/// The largest link is 40 mm long, so the centres of two links that hang in each other are nearer than 40 mm.
Outcome chainHangs(const Run& run) {
  constexpr double kLink_m = 40e-3;
  double farthest_m = 0;
  for (std::size_t i = 1; i < run.bodies.size(); ++i)
    farthest_m = std::max(farthest_m, (run.bodies[i].X_WB.back().p - run.bodies[i - 1].X_WB.back().p).norm());
  return {farthest_m < kLink_m, text("centres of neighbours %.2f mm apart at most", 1e3 * farthest_m)};
}

/// The stones are drawn half a millimetre apart, so the arch first settles by 27 mm at its top and then
/// stands still.
Outcome archStands(const Run& run) {
  double moved_m = 0;
  for (const Body& body : run.bodies)
    moved_m = std::max(moved_m, (body.X_WB.back().p - body.X_WB[body.X_WB.size() / 2].p).norm());
  const double energy_J = run.kineticEnergy_J(run.energy_J.size() - 1);
  return {energy_J < 1e-9 && moved_m < 0.1e-3,
          text("%.2g J at the end, stones moved by %.3f mm in the second half", energy_J, 1e3 * moved_m)};
}

/// Rotation about the axis over a range of steps.
double turned_rad(const Body& body, std::size_t from, std::size_t to, const Vec3& axis) {
  double sum_rad = 0;
  for (std::size_t i = from + 1; i <= to; ++i)
    sum_rad += rotationVector(body.X_WB[i].R * body.X_WB[i - 1].R.transpose()).dot(axis);
  return sum_rad;
}

/// Without friction the angular acceleration of a screw about its axis is g / r / (1 + I / (m r^2)) with r =
/// lead / (2 pi). The lead is the measured lead.
Outcome screwTurns(const Run& run) {
  const Body& screw = run.bodies.front();
  const Vec3 down = run.gravity_W.normalized();
  const std::size_t to = screw.X_WB.size() - 1,
                    from = to / 10;  // the screw first falls through its clearance
  const double advance_m = down.dot(screw.X_WB[to].p - screw.X_WB[from].p);
  const double turn_rad = std::abs(turned_rad(screw, from, to, down));
  const double spin_rad_s = std::abs(down.dot(screw.V_W[to].w - screw.V_W[from].w));
  const double measured_rad_s2 = spin_rad_s / (static_cast<double>(to - from) * run.dt_s);
  const Vec3 axis_B = screw.X_WB[from].R.transpose() * down;
  const double inertia_kg_m2 = axis_B.cwiseAbs2().dot(screw.frame.inertia_kg_m2);
  const double radius_m = advance_m / turn_rad;
  const double theory_rad_s2 =
      run.gravity_W.norm() / radius_m / (1 + inertia_kg_m2 / (screw.frame.mass_kg * radius_m * radius_m));
  const double ratio = measured_rad_s2 / theory_rad_s2;
  return {std::abs(ratio - 1) <= 0.02,
          text("%.4f of theory's acceleration, %.2f mm down, %.2f turns, lead %.3f mm", ratio,
               1e3 * advance_m, turn_rad / (2 * std::numbers::pi), 1e3 * 2 * std::numbers::pi * radius_m)};
}

/// Three vertical walls are 20 um from three faces of the tetrahedron. Without friction nothing pushes the
/// tetrahedron aside, neither while it falls nor on the floor.
Outcome tetrahedronDrops(const Run& run) {
  const Body& body = run.bodies.front();
  const Vec3 moved = body.X_WB.back().p - body.X_WB.front().p;
  constexpr double kWay_m = 44.04404e-3, kGap_m = 20e-6;
  return {Vec3(moved.x(), 0, moved.z()).norm() < kGap_m && std::abs(moved.y() + kWay_m) < kGap_m,
          text("centre moved by %.3f, %.3f, %.3f mm", 1e3 * moved.x(), 1e3 * moved.y(), 1e3 * moved.z())};
}

Outcome tipsOffItsCorner(const Run& run) {
  const Body& body = run.bodies.front();
  const double tilt_rad = rotationVector(body.X_WB.back().R * body.X_WB.front().R.transpose()).norm();
  const double fallen_m = run.gravity_W.normalized().dot(body.X_WB.back().p - body.X_WB.front().p);
  return {tilt_rad > 0.5, text("turned by %.2f rad, %.1f mm below its start", tilt_rad, 1e3 * fallen_m)};
}

struct Peer {
  const char* name;
  double seconds;
  const char* expected;
  Outcome (*check)(const Run&);
};
constexpr Peer kPeers[] = {
    {"tet-corner", 5, "drops straight onto the floor and stays there", tetrahedronDrops},
    {"vertex-face", 2, "tips off its corner", tipsOffItsCorner},
    {"bolt", 0.5, "turns down at theory's rate within 2 %", screwTurns},
    {"10-links", 1, "hangs", chainHangs},
    {"arch-101", 1, "stands still: below 1e-9 J", archStands},
};

const Peer& peerOf(const std::string& scene) {
  for (const Peer& peer : kPeers)
    if (peer.name == scene) return peer;
  throw std::invalid_argument(scene + " is none of the peer's scenes");
}

// The tetrahedron of `vertex-face` is exactly balanced on its corner, so that its further motion would depend
// on rounding. The tetrahedron is tilted by a millionth of a radian, which is 10 nm at its upper face.
constexpr double kOffBalance_rad = 1e-6;

Run prepare(const scenes::Scene& scene) {
  Run run;
  run.dt_s = 1 / scene.fidelity.physics_rate_hz;
  run.gravity_W = scene.gravity_W;
  for (const scenes::ScenePart& part : scene.parts)
    if (!part.is_fixed)
      run.bodies.push_back(
          {bullet::makeBodyFrame(massProperties(part.part.mesh), part.part.material.density_kg_m3), {}, {}});
  return run;
}

void keep(Run& run, const std::vector<scenes::BodyState>& states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    Body& body = run.bodies[i];
    const Vec3 p_PB_W = states[i].X_WP.R * body.frame.X_PB.p;
    const Twist& V = states[i].V_WP_W;
    body.X_WB.push_back(states[i].X_WP * body.frame.X_PB);
    body.V_W.push_back({V.w, V.v + V.w.cross(p_PB_W)});
  }
  run.energy_J.push_back(run.energyAt_J(run.energy_J.size()));
}

void judgeEnergy(const Run& run, double limit_m, PeerResult& result) {
  double least_J = 1e300, weight_N = 0, fastest_m_s = 0;
  for (const double energy_J : run.energy_J) {
    least_J = std::min(least_J, energy_J);
    result.energy_rise_J = std::max(result.energy_rise_J, energy_J - least_J);
  }
  for (const Body& body : run.bodies) {
    weight_N += body.frame.mass_kg * run.gravity_W.norm();
    for (const Twist& V : body.V_W) fastest_m_s = std::max(fastest_m_s, V.v.norm());
  }
  result.energy_limit_J = weight_N * (limit_m + fastest_m_s * run.dt_s / 2);
}

}  // namespace

std::vector<std::string> peerScenes() {
  std::vector<std::string> names;
  for (const Peer& peer : kPeers) names.emplace_back(peer.name);
  return names;
}

PeerResult runPeer(const std::filesystem::path& folder, const std::string& name, double seconds) {
  const auto begun = std::chrono::steady_clock::now();
  const Peer& peer = peerOf(name);
  scenes::Scene scene = scenes::loadScene((folder / name / "scene.toml").string());
  scenes::resolveFidelity(scene);
  if (name == "vertex-face")
    for (scenes::ScenePart& part : scene.parts)
      if (!part.is_fixed) part.X_WP.R = rotationFromVector(kOffBalance_rad * Vec3::UnitX()) * part.X_WP.R;
  Run run = prepare(scene);
  scenes::SimulateOptions options;
  options.judge_every = 1;
  options.trace = [&](double, const std::vector<scenes::BodyState>& bodies, double) { keep(run, bodies); };
  PeerResult result;
  result.scene = name;
  result.seconds = seconds > 0 ? seconds : peer.seconds;
  const scenes::SimulateResult simulated = scenes::simulate(scene, result.seconds, options);
  const scenes::JudgedOverlap& overlap = *simulated.overlap;
  result.deepest_m = overlap.deepest.depth_m;
  result.limit_m = overlap.limit_m;
  result.deepest_pair =
      overlap.deepest.a + " in " + overlap.deepest.b + text(" at %.3f s", overlap.deepest.time_s);
  result.overlapping_starts = overlap.at_start.size();
  judgeEnergy(run, result.limit_m, result);
  const Outcome outcome = peer.check(run);
  result.expected = peer.expected;
  result.found = outcome.found;
  result.happens = outcome.happens;
  result.step_p99_us = simulated.step.p99_us;
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace vps::peers
