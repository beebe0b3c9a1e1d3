// SPDX-License-Identifier: BSD-3-Clause
#include "pages/sections.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "files/external.h"
#include "files/html.h"
#include "mesh/coarse_mesh.h"
#include "mesh/scene_meshes.h"
#include "mesh/shading_mesh.h"
#include "vps_scenes/cad/colors.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {
namespace {

using Json = nlohmann::ordered_json;

// The copyright notice of three.js, which its licence requires.
constexpr const char* kThreeNotice = R"(<!--
three.js is part of this page. Copyright 2010-2019 three.js authors. Its licence, MIT:
Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated documentation
files (the "Software"), to deal in the Software without restriction, including without limitation the rights to use, copy,
modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to permit persons to whom the Software
is furnished to do so, subject to the following conditions: The above copyright notice and this permission notice shall be
included in all copies or substantial portions of the Software.
THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES
OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE
LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR
IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
-->
)";

constexpr const char* kRunViewBox = R"(<div id="run-view"><div class="screen"><canvas></canvas></div>
<div class="controls"><button type="button">Play</button><input type="range" min="0" aria-label="time of the run">
<select aria-label="view"><option value="corner">from a corner</option><option value="front">front</option>
<option value="right">right</option><option value="back">back</option><option value="left">left</option>
<option value="top">top</option></select></div>
<output></output><p class="quiet">Drag to turn, scroll or pinch to come nearer. Blue: the part in hand; pale blue: its target.</p></div>
)";

std::string scriptElement(const std::string& attributes, const std::string& text) {
  return std::string("<script").append(attributes).append(">").append(text).append("</script>\n");
}

/// JSON without "<", so that a part's name cannot end the HTML element around it.
std::string textOf(const Json& data) {
  std::string text = data.dump(-1, ' ', true, Json::error_handler_t::replace);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1))
    text.replace(at, 1, "\\u003c");
  return text;
}

template <typename T>
std::string encoded(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span(values)));
}

double rounded(double value, double unit) {
  return std::isfinite(value) ? std::round(value / unit) * unit : 0;
}

/// Appends a pose in mm. Positions are rounded to 0.1 um, rotations to an angle that moves a point at a
/// distance of 1 m by 0.1 um.
void addPose(Json& to, const Pose& X) {
  for (int k = 0; k < 3; ++k) to.push_back(rounded(1e3 * X.p[k], 1e-4));
  const Eigen::Quaterniond q(X.R);
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) to.push_back(rounded(value, 1e-7));
}

Json poseOf(const Pose& X) {
  Json pose = Json::array();
  addPose(pose, X);
  return pose;
}

std::string webColor(const std::array<float, 3>& linear) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", scenes::srgbByte(linear[0]), scenes::srgbByte(linear[1]),
                scenes::srgbByte(linear[2]));
  return text;
}

void addPoint(std::vector<float>& to, const std::array<float, 3>& p, const Vec3& center_m) {
  for (std::size_t k = 0; k < 3; ++k)
    to.push_back(static_cast<float>(1e3 * (p[k] + center_m[static_cast<int>(k)])));
}

Json partData(const DrawnMesh& part, std::size_t wanted) {
  const ShadingMesh mesh = buildShadingMesh(*part.mesh, kCreaseAngle_rad, part.face_colors);
  std::vector<float> places, edges;
  std::vector<std::int8_t> normals;
  std::vector<std::uint8_t> colors;
  // Only vertices that the coarser mesh uses are written, in the order of first use.
  std::vector<std::uint32_t> triangles = CoarseMesh(mesh).indices(wanted);
  std::vector<std::uint32_t> number(mesh.vertices.size(), UINT32_MAX);
  std::uint32_t count = 0;
  for (std::uint32_t& i : triangles) {
    if (number[i] == UINT32_MAX) {
      number[i] = count++;
      addPoint(places, mesh.vertices[i].p, mesh.center);
      for (const float n : mesh.vertices[i].n)
        normals.push_back(static_cast<std::int8_t>(std::lround(127 * n)));
      for (std::size_t k = 0; !mesh.colors.empty() && k < 3; ++k)
        colors.push_back(scenes::srgbByte(mesh.colors[i][k]));
    }
    i = number[i];
  }
  for (const ShadingEdge& edge : mesh.sharp_edges) {
    addPoint(edges, edge.a, mesh.center);
    addPoint(edges, edge.b, mesh.center);
  }
  Json data = {{"color", webColor(part.color)}, {"fixed", part.is_fixed},
               {"pose", poseOf(part.X_WP)},     {"places", encoded(places)},
               {"normals", encoded(normals)},   {"triangles", encoded(triangles)},
               {"edges", encoded(edges)}};
  if (!colors.empty()) data["colors"] = encoded(colors);
  return data;
}

Json partsData(const RenderScene& drawn) {
  std::size_t total = 0;
  for (const DrawnMesh& part : drawn) total += part.mesh->triangles.size();
  Json parts = Json::array();
  for (const DrawnMesh& part : drawn) {
    const double share = std::min(1.0, static_cast<double>(kRunViewTriangles) / static_cast<double>(total));
    parts.push_back(
        partData(part, static_cast<std::size_t>(share * static_cast<double>(part.mesh->triangles.size()))));
  }
  return parts;
}

/// [part, pose ...] for each body of the snapshot.
Json bodiesOf(const std::vector<PartExtent>& extents, const scenes::Snapshot& snapshot) {
  Json bodies = Json::array();
  forEachVisiblePart(extents, snapshot, false, [&](std::size_t part, const Pose& X_WP, scenes::BodyRole) {
    Json body = {part};
    addPose(body, X_WP);
    bodies.push_back(std::move(body));
  });
  return bodies;
}

Json stepsData(const std::vector<PartExtent>& extents, const scenes::Scene& scene,
               const scenes::AssembleResult& result) {
  Json steps = Json::array();
  for (std::size_t i = 0; i < result.start.size() && i < scene.steps.size(); ++i)
    steps.push_back({{"part", scene.steps[i].part},
                     {"name", std::to_string(i + 1) + ". " + scene.parts[scene.steps[i].part].part.name},
                     {"target", poseOf(scene.steps[i].X_WP_target)},
                     {"bodies", bodiesOf(extents, result.start[i])}});
  return steps;
}

/// [time, step, pose ..., force, depth, contacts] at equal intervals, and the last row of the run.
Json framesData(const scenes::AssembleResult& result, std::size_t steps) {
  Json frames = Json::array();
  std::vector<scenes::TraceRow> rows = thinned(result.trace, kRunViewRate_hz);
  if (!rows.empty() && rows.back().time_s < result.trace.back().time_s) rows.push_back(result.trace.back());
  for (const scenes::TraceRow& row : rows) {
    if (row.step < 0 || static_cast<std::size_t>(row.step) >= steps) continue;
    Json frame = {rounded(row.time_s, 1e-3), row.step};
    addPose(frame, row.X_WP);
    frame.push_back(rounded(row.F_hand_W.f.norm(), 1e-2));
    frame.push_back(rounded(1e6 * row.depth_m, 1e-2));
    frame.push_back(row.contacts);
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// A vector in mm.
Json boxOf(const Box& box) {
  const Vec3 min_mm = 1e3 * box.min, max_mm = 1e3 * box.max;
  return {{"min", {min_mm.x(), min_mm.y(), min_mm.z()}}, {"max", {max_mm.x(), max_mm.y(), max_mm.z()}}};
}

Json runData(const scenes::Scene& scene, const scenes::AssembleResult& result) {
  const RenderScene drawn = drawnMeshes(scene);
  const std::vector<PartExtent> extents = partExtents(drawn);
  const Box finished = visibleBounds(extents, result.finished, false, true);
  Box seen = finished;
  for (const scenes::Snapshot& start : result.start) {
    const Box box = visibleBounds(extents, start, false, true);
    seen.add(box.min);
    seen.add(box.max);
  }
  Json steps = stepsData(extents, scene, result);
  Json frames = framesData(result, steps.size());
  return {{"run", boxOf(seen)},          {"assembly", boxOf(finished.isEmpty() ? seen : finished)},
          {"parts", partsData(drawn)},   {"steps", std::move(steps)},
          {"frames", std::move(frames)}, {"finished", bodiesOf(extents, result.finished)}};
}

}  // namespace

RunView runView(const scenes::Scene& scene, const scenes::AssembleResult& result) {
  const std::string folder = kThreeFolder;
  const std::string library = textOf(folder + "build/three.min.js");
  const std::string controls = textOf(folder + "examples/js/controls/OrbitControls.js");
  if (library.empty() || controls.empty())
    return {{},
            "three.js, which draws the run in the browser, is not in " + folder + ": install libjs-three"};
  RunView view;
  view.html = kThreeNotice;
  view.html.append(kRunViewBox)
      .append(scriptElement(" type=\"application/json\" id=\"run-data\"", textOf(runData(scene, result))))
      .append(scriptElement("", library))
      .append(scriptElement("", controls))
      .append(scriptElement("", kRunViewScript));
  return view;
}

std::vector<scenes::TraceRow> thinned(const std::vector<scenes::TraceRow>& trace, double rate_hz) {
  std::vector<scenes::TraceRow> rows;
  double next_s = 0;
  for (const scenes::TraceRow& row : trace) {
    // The tolerance of half a microsecond is for the rounding of times, which are sums of steps.
    if (row.time_s < next_s - 0.5e-6) continue;
    rows.push_back(row);
    next_s = std::max(next_s + 1 / rate_hz, row.time_s);
  }
  return rows;
}

}  // namespace vps::viewer
