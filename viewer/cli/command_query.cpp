// SPDX-License-Identifier: BSD-3-Clause
// vps query: contact of two meshes at given poses of B in A.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "table.h"
#include "terminal.h"
#include "vps/load_error.h"
#include "vps/mesh_repair.h"
#include "vps/pair_query.h"
#include "vps/query.h"
#include "vps_scenes/import.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

/// "x,y,z,qx,qy,qz,qw" in metres. Throws LoadError that begins with `where`.
Pose poseFromText(const std::string& text, const std::string& where) {
  double values[7];
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < 7; ++i) {
    while (at != end && (*at == ' ' || *at == '\t')) ++at;
    const auto read = std::from_chars(at, end, values[i]);
    at = read.ptr;
    while (at != end && (*at == ' ' || *at == '\t')) ++at;
    const bool is_separated = i == 6 ? at == end : at != end && *at == ',';
    if (read.ec != std::errc{} || !is_separated || !std::isfinite(values[i]))
      throw LoadError(where, "",
                      "'" + text + "' is no pose; expected seven numbers: x,y,z,qx,qy,qz,qw (metres)");
    if (i < 6) ++at;
  }
  const Quat rotation(values[6], values[3], values[4], values[5]);
  if (std::abs(rotation.norm() - 1) > 1e-3)
    throw LoadError(where, "", "'" + text + "' is no pose; the length of qx,qy,qz,qw must be 1");
  return {rotation, Vec3(values[0], values[1], values[2])};
}

std::vector<Pose> readPoses(const QueryArguments& given) {
  if (given.poses.empty()) return {given.pose.empty() ? Pose() : poseFromText(given.pose, "--pose")};
  std::error_code error;
  if (fs::is_directory(given.poses, error))
    throw LoadError(given.poses, "", "is a folder; expected a file with a pose on each line");
  if (!fs::exists(given.poses, error)) throw LoadError(given.poses, "", "no such file");
  std::ifstream in(given.poses);
  if (!in) throw LoadError(given.poses, "", "cannot be read");
  std::vector<Pose> poses;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos || line.starts_with('#')) continue;
    poses.push_back(poseFromText(line, given.poses + ":" + std::to_string(number)));
  }
  if (poses.empty())
    throw LoadError(given.poses, "", "has no pose; expected a line x,y,z,qx,qy,qz,qw for each");
  return poses;
}

/// All parts of a file as one mesh, in the file's frame. Says what the file lacks.
Mesh readMesh(const std::string& file, const std::string& units) {
  scenes::ImportSettings settings;
  if (!units.empty()) {
    settings.unit_m = scenes::unitFromText(units);
    if (!settings.unit_m)
      throw LoadError("", "", "--units is '" + units + "'; expected one of: mm, cm, m, um, inch");
  }
  const scenes::ImportedCad cad = scenes::importCad(file, settings);
  for (const std::string& warning : cad.warnings) warn(file + ": " + warning);
  Mesh mesh;
  for (const scenes::ImportedPart& part : cad.parts) append(mesh, transformed(part.mesh, part.X_WP));
  requireUsable(mesh, file, "");
  return mesh;
}

/// Between its samples the field is linear: it cannot turn back within a wall thinner than two voxels.
void warnIfThin(const Mesh& mesh, double voxel_m, const std::string& file) {
  const double thinnest_m = bounds(mesh).size().minCoeff();
  if (voxel_m > thinnest_m / 2)
    warn(file + ": is " + fixed(thinnest_m * 1e3, 3) + " mm thin, less than two voxels of " +
         fixed(voxel_m * 1e3, 3) + " mm: depths in it mean little; take a finer --voxel");
}

VoxMap mapOf(const Mesh& mesh, const VoxMapSettings& settings, const std::string& file,
             const std::optional<VoxMapCache>& cache, const Progress& progress) {
  MeshReport report;
  VoxMap map = cache ? cache->build(mesh, settings, file, progress, &report)
                     : buildVoxMap(mesh, settings, file, progress, &report);
  if (report.signed_by_winding) warn(file + ": is no closed surface: " + describe(report));
  return map;
}

/// One side of the test: the points of one mesh against the field of the other.
struct Side {
  VoxMap map;
  PointShell shell;

  Side(const Mesh& field, const Mesh& points, const Fidelity& fidelity, const std::string& field_name,
       const std::string& points_name, const std::optional<VoxMapCache>& cache, const Progress& progress)
      : map(mapOf(field, {.voxel_m = fidelity.voxel_m}, field_name, cache, progress)),
        shell(buildPointShell(points, {.spacing_m = fidelity.spacing_m}, points_name, progress)) {}
  [[nodiscard]] std::size_t memoryBytes() const { return map.memoryBytes() + shell.memoryBytes(); }
};

/// The options of a query.
struct Asking {
  Gradient gradient = Gradient::Continuous;
  double k_N_per_m3 = 0;

  Asking(const QueryArguments& given, const Fidelity& fidelity)
      : gradient(fidelity.gradient), k_N_per_m3(given.stiffness_N_per_m3) {}
};

struct SideResult {
  QueryResult distance;
  std::size_t contact_count = 0, points_tested = 0;
  Wrench F_M;  ///< on the shell's part about p_MO
};

SideResult ask(Side& side, const Pose& X_MP, const Vec3& p_MO, const Asking& asking) {
  SideResult answer;
  TouchSummary sum;
  const QueryOptions options = {.gradient = asking.gradient};
  answer.points_tested =
      queryWrench(side.map, side.shell, X_MP, options, asking.k_N_per_m3, p_MO, sum).points_tested;
  answer.contact_count = sum.count;
  answer.F_M = sum.F_O_M;
  answer.distance = queryDistance(side.map, side.shell, X_MP);
  return answer;
}

/// The field ends at the band. A millionth of it: the reading is a float.
bool isSaturated(const QueryResult& found, const VoxMap& map) {
  return found.min_distance_m <= -map.band_m() * (1 - 1e-6);
}

/// `b_in_a`: B's points in A's field; `a_in_b`, when both sides are asked, the reverse. Each then counts
/// half.
PoseAnswer answerAt(const Pose& X_AB, Side& b_in_a, std::optional<Side>& a_in_b, const Asking& asking) {
  PoseAnswer answer;
  answer.X_AB = X_AB;
  const SideResult first = ask(b_in_a, X_AB, X_AB.p, asking);
  answer.min_distance_m = first.distance.min_distance_m;
  answer.is_beyond = first.distance.is_beyond_band;
  answer.is_saturated = isSaturated(first.distance, b_in_a.map);
  answer.contact_count = first.contact_count;
  answer.points_tested = first.points_tested;
  answer.F_Bo_A = first.F_M;
  if (!a_in_b) return answer;

  const SideResult second = ask(*a_in_b, X_AB.inverse(), Vec3::Zero(), asking);
  answer.min_distance_m = std::min(answer.min_distance_m, second.distance.min_distance_m);
  answer.is_beyond = answer.is_beyond && second.distance.is_beyond_band;
  answer.is_saturated = answer.is_saturated || isSaturated(second.distance, a_in_b->map);
  answer.contact_count += second.contact_count;
  answer.points_tested += second.points_tested;
  answer.F_Bo_A = bothWays(first.F_M, second.F_M, X_AB.R);
  return answer;
}

scenes::TickTimes summary(std::vector<double>& us) {
  std::sort(us.begin(), us.end());
  const auto at = [&](double share) {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  scenes::TickTimes times;
  times.count = us.size();
  times.p50_us = at(0.5);
  times.p99_us = at(0.99);
  times.max_us = us.back();
  return times;
}

double spacingFor(const Mesh& mesh, std::size_t points) {
  return std::sqrt(area(mesh) / static_cast<double>(points));
}

std::string tableOf(const QueryAnswer& answer) {
  Table table({"pose", "distance [um]", "depth [um]", "contacts", "tested", "force [N]", "torque [N m]"});
  for (std::size_t i = 0; i < answer.poses.size(); ++i) {
    const PoseAnswer& pose = answer.poses[i];
    const char* const bound = pose.is_beyond ? "> " : pose.is_saturated ? "< " : "";
    table.add({std::to_string(i + 1), bound + fixed(pose.min_distance_m * 1e6, 2),
               (pose.is_saturated ? "> " : "") + fixed(pose.maxDepth_m() * 1e6, 2),
               std::to_string(pose.contact_count), std::to_string(pose.points_tested),
               fixed(pose.F_Bo_A.f.norm(), 4), fixed(pose.F_Bo_A.tau.norm(), 6)});
  }
  return table.text();
}

}  // namespace

int runQuery(const QueryArguments& given) {
  if (!(given.stiffness_N_per_m3 >= 0) || !std::isfinite(given.stiffness_N_per_m3))
    throw LoadError("", "", "--stiffness must be a finite number of at least 0");
  Fidelity fidelity = fidelityFrom(given.fidelity, fidelityPreset("normal"));
  const std::vector<Pose> poses = readPoses(given);
  OutputFile json(given.json, {given.mesh_a, given.mesh_b, given.poses});
  ProgressBar bar;

  const Mesh mesh_a = readMesh(given.mesh_a, given.units), mesh_b = readMesh(given.mesh_b, given.units);
  warnIfThin(mesh_a, fidelity.voxel_m, given.mesh_a);
  if (fidelity.sides == Sides::Both) warnIfThin(mesh_b, fidelity.voxel_m, given.mesh_b);
  if (given.fidelity.points > 0) fidelity.spacing_m = spacingFor(mesh_b, given.fidelity.points);
  QueryAnswer answer;
  answer.mesh_a = given.mesh_a;
  answer.mesh_b = given.mesh_b;
  answer.voxel_m = fidelity.voxel_m;
  answer.point_spacing_m = fidelity.spacing_m;
  const Asking asking(given, fidelity);
  const std::optional<VoxMapCache> cache = cacheFrom(given.cache);
  const auto begun = Clock::now();
  Side b_in_a(mesh_a, mesh_b, fidelity, given.mesh_a, given.mesh_b, cache, bar.progress());
  std::optional<Side> a_in_b;
  if (fidelity.sides == Sides::Both)
    a_in_b.emplace(mesh_b, mesh_a, fidelity, given.mesh_b, given.mesh_a, cache, bar.progress());
  answer.build_wall_s = secondsSince(begun);
  answer.points_total = b_in_a.shell.size() + (a_in_b ? a_in_b->shell.size() : 0);
  answer.memory_bytes = b_in_a.memoryBytes() + (a_in_b ? a_in_b->memoryBytes() : 0);

  const std::size_t repeats = given.repeats > 0 ? static_cast<std::size_t>(given.repeats)
                                                : std::max<std::size_t>(1, 100 / poses.size());
  std::vector<double> us;
  us.reserve(repeats * poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    bar.progress()("asking", static_cast<double>(i) / static_cast<double>(poses.size()));
    PoseAnswer pose;
    for (std::size_t run = 0; run < repeats; ++run) {
      const auto asked = Clock::now();
      pose = answerAt(poses[i], b_in_a, a_in_b, asking);
      us.push_back(secondsSince(asked) * 1e6);
    }
    answer.poses.push_back(pose);
  }
  answer.time = summary(us);
  throwIfStopped();
  json.write(toJson(answer));
  bar.clear();

  std::fputs(tableOf(answer).c_str(), stdout);
  std::printf("voxel %s mm, %zu points %s mm apart, %s MB, built in %s s; a pose took %s us (median)\n",
              fixed(answer.voxel_m * 1e3, 3).c_str(), answer.points_total,
              fixed(answer.point_spacing_m * 1e3, 3).c_str(),
              fixed(static_cast<double>(answer.memory_bytes) * 1e-6, 1).c_str(),
              fixed(answer.build_wall_s, 2).c_str(), fixed(answer.time.p50_us, 1).c_str());
  return kGood;
}

}  // namespace vps::viewer
