// SPDX-License-Identifier: BSD-3-Clause
#include "case_run.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace vps::search {

namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string list(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    text.append(text.empty() ? "[" : ", ");
    text.append(number(value));
  }
  return text.append("]");
}

std::string list(const Vec3& v) {
  return list({v.x(), v.y(), v.z()});
}

std::string stl(const Mesh& mesh) {
  std::string out(80, ' ');
  const auto put = [&](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const std::uint32_t v : triangle)
      for (int k = 0; k < 3; ++k) put(static_cast<float>(mesh.vertices[v][k]));
    put(std::uint16_t{0});
  }
  return out;
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

/// The case started from another state, without the hand.
Case startedAt(const Case& made, const std::vector<BodyMotion>& state, double seconds) {
  Case started = made;
  started.hand.reset();
  started.seconds = seconds;
  for (std::size_t i = 0; i < state.size(); ++i) {
    started.bodies[i].X_WP = state[i].X_WP;
    started.bodies[i].V_WP_W = state[i].V_W;
  }
  return started;
}

struct Start {
  Case made;
  double time_s = 0;
  bool shows_overlap = false;
};

Start findStart(const Case& made, const RunSettings& settings, const CaseResult& result) {
  RunSettings repeated = settings;
  repeated.stops_at_bound = true;
  for (std::size_t back = 1; back <= result.before.size(); back *= 2) {
    const double seconds = 2.5 * static_cast<double>(back) * settings.step_s;
    Start start{startedAt(made, result.before[result.before.size() - back], seconds),
                result.before_s - static_cast<double>(back - 1) * settings.step_s, false};
    start.shows_overlap = !runCase(start.made, repeated).before.empty();
    if (start.shows_overlap) return start;
  }
  return {startedAt(made, result.before.back(), 10 * settings.step_s), result.before_s, false};
}

std::string partText(const CaseBody& body) {
  std::string text = "\n[[part]]\nfile = \"" + body.name + ".stl\"\n";
  text.append("fixed = ").append(body.is_fixed ? "true" : "false");
  text.append("\nfriction = ").append(number(body.friction));
  // Poses are rounded to the bit, but a state in contact may have an overlap of nanometres.
  text.append("\nallow_overlap = true\n");
  const Quat q = body.X_WP.quaternion();
  text.append("pose = {position = ").append(list(body.X_WP.p));
  text.append(", rotation_xyzw = ").append(list({q.x(), q.y(), q.z(), q.w()})).append("}\n");
  if (body.is_fixed) return text;
  // A scene states the velocity of the part's origin.
  const Vec3 from_com = -(body.X_WP.R * massProperties(body.mesh).com);
  text.append("velocity_m_s = ").append(list(Vec3(body.V_WP_W.v + body.V_WP_W.w.cross(from_com))));
  text.append("\nangular_velocity_rad_s = ").append(list(body.V_WP_W.w));
  return text.append("\n");
}

}  // namespace

std::filesystem::path saveCase(const std::filesystem::path& folder, const Case& made,
                               const RunSettings& settings, const CaseResult& result,
                               const std::string& command) {
  const Start start = findStart(made, settings, result);
  std::filesystem::create_directories(folder);
  char head[256];
  std::snprintf(head, sizeof head, "# %.1f um deep at %.4f s of the run, %s in %s. The state of %.4f s.\n",
                1e6 * result.deepest.overlap.depth_m, result.deepest_at_s,
                made.bodies[result.deepest.a].name.c_str(), made.bodies[result.deepest.b].name.c_str(),
                start.time_s);
  std::string text = head;
  if (!start.shows_overlap) text.append("# From here the overlap appears only with the hand:\n");
  text.append("# ").append(command).append("\nunit = \"m\"\n\n[fidelity]\nphysics_rate_hz = ");
  text.append(number(1 / settings.step_s)).append("\ncontact = \"");
  text.append(settings.mode == dynamics::Mode::Penalty ? "penalty" : "constraint").append("\"\n");
  for (const CaseBody& body : start.made.bodies) {
    text.append(partText(body));
    write(folder / (body.name + ".stl"), stl(body.given));
  }
  write(folder / "scene.toml", text);
  return folder / "scene.toml";
}

}  // namespace vps::search
