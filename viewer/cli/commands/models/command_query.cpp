// SPDX-License-Identifier: BSD-3-Clause
// vps query: computes the contact of two parts at given poses of B in A.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include "input/file_kind.h"
#include "input/level_set_file.h"
#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps/query.h"
#include "vps/solid.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct QueryArguments {
  std::string mesh_a, mesh_b;
  std::string pose, poses;  ///< "x,y,z,qx,qy,qz,qw", or a file of such lines
  std::string units, json;
  std::string cache;  ///< folder for voxmaps; empty: none
  FidelityArguments fidelity;
  double stiffness_N_per_m3 = 1e12;
  int repeats = 0;  ///< timed runs of each pose; 0: about 100 runs shared by all poses
};

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
                      "'" + text + "' is not a pose; expected seven numbers: x,y,z,qx,qy,qz,qw (metres)");
    if (i < 6) ++at;
  }
  const Quat rotation(values[6], values[3], values[4], values[5]);
  if (std::abs(rotation.norm() - 1) > 1e-3)
    throw LoadError(where, "", "'" + text + "' is not a pose; the length of qx,qy,qz,qw must be 1");
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
  if (poses.empty()) throw LoadError(given.poses, "", "has no pose; expected lines x,y,z,qx,qy,qz,qw");
  return poses;
}

/// The field is linear between its nodes, so it cannot represent a wall thinner than two voxels.
void warnIfThin(const Mesh& mesh, double voxel_m, const std::string& file) {
  const double thinnest_m = bounds(mesh).size().minCoeff();
  if (voxel_m > thinnest_m / 2)
    warn(file + ": is " + fixed(thinnest_m * 1e3, 3) + " mm thin, less than two voxels of " +
         fixed(voxel_m * 1e3, 3) + " mm: depths in this part are unreliable; use a finer --voxel");
}

/// The contents of the two files: meshes, or the voxmap of A and the pointshell of B.
struct Operands {
  std::optional<Mesh> mesh_a, mesh_b;
  std::optional<VoxMap> map_a;        ///< set if A is a .vdb file
  std::optional<PointShell> shell_b;  ///< set if B is a .ply file with normals and no faces

  [[nodiscard]] bool hasBothMeshes() const { return mesh_a && mesh_b; }
};

void requireNotGiven(bool is_given, const std::string& option, const std::string& file, const char* holds) {
  if (is_given)
    throw LoadError(file, "", std::string("holds a ") + holds + " already; leave " + option + " out");
}

Operands loadOperands(const QueryArguments& given) {
  Operands operands;
  const std::optional<double> unit_m = unitFrom(given.units);
  const OperandKind a = operandKind(given.mesh_a), b = operandKind(given.mesh_b);
  if (a == OperandKind::PointShell)
    throw LoadError(given.mesh_a, "", "is a pointshell, but A provides the voxmap; give it second, as B");
  if (b == OperandKind::LevelSet)
    throw LoadError(given.mesh_b, "", "is a level set, but B provides the pointshell; give it first, as A");
  if (a == OperandKind::LevelSet) {
    requireNotGiven(!given.fidelity.voxel.empty(), "--voxel", given.mesh_a, "voxmap");
    operands.map_a = loadLevelSet(given.mesh_a);
  } else {
    operands.mesh_a = readMesh(given.mesh_a, unit_m);
  }
  if (b == OperandKind::PointShell) {
    requireNotGiven(!given.fidelity.spacing.empty(), "--spacing", given.mesh_b, "pointshell");
    requireNotGiven(given.fidelity.points > 0, "--points", given.mesh_b, "pointshell");
    operands.shell_b = loadPly(given.mesh_b);
  } else {
    operands.mesh_b = readMesh(given.mesh_b, unit_m);
  }
  return operands;
}

/// The reverse query needs the voxmap of B and the pointshell of A, which are built from meshes.
bool isTwoSided(const Operands& operands, const Fidelity& fidelity, const QueryArguments& given) {
  if (fidelity.sides == Sides::One || operands.hasBothMeshes()) return fidelity.sides == Sides::Both;
  if (given.fidelity.sides == "both")
    throw LoadError(operands.mesh_a ? given.mesh_b : given.mesh_a, "",
                    "has no mesh, and --sides both needs the meshes of both parts; use --sides one");
  return false;
}

/// One direction of the query: the points of one part in the field of the other.
struct OneWay {
  VoxMap map;
  PointShell shell;
  [[nodiscard]] std::size_t memoryBytes() const { return map.memoryBytes() + shell.memoryBytes(); }
};

struct QuerySettings {
  Gradient gradient = Gradient::Continuous;
  double k_N_per_m3 = 0;
};

struct OneWayResult {
  QueryResult distance;
  std::size_t contact_count = 0, points_tested = 0;
  Wrench F_M;  ///< wrench on the pointshell's part about p_MO
};

OneWayResult queryOneWay(const OneWay& models, const Pose& X_MP, const Vec3& p_MO,
                         const QuerySettings& settings) {
  OneWayResult result;
  TouchSummary sum;
  const QueryOptions options = {.gradient = settings.gradient};
  result.points_tested =
      queryWrench(models.map, models.shell, X_MP, options, settings.k_N_per_m3, p_MO, sum).points_tested;
  result.contact_count = sum.count;
  result.F_M = sum.F_O_M;
  result.distance = queryDistance(models.map, models.shell, X_MP);
  return result;
}

/// Whether the depth is the band's width, where the field ends, so that the true depth may be greater. The
/// tolerance of a millionth covers the rounding of float.
bool isSaturated(const QueryResult& found, const VoxMap& map) {
  return found.min_distance_m <= -map.band_m() * (1 - 1e-6);
}

/// @param b_in_a B's points in A's field
/// @param a_in_b A's points in B's field, if the query is two-sided; each direction then counts half
PoseAnswer queryAt(const Pose& X_AB, const OneWay& b_in_a, const std::optional<OneWay>& a_in_b,
                   const QuerySettings& settings) {
  PoseAnswer answer;
  answer.X_AB = X_AB;
  const OneWayResult first = queryOneWay(b_in_a, X_AB, X_AB.p, settings);
  answer.min_distance_m = first.distance.min_distance_m;
  answer.is_beyond = first.distance.is_beyond_band;
  answer.is_saturated = isSaturated(first.distance, b_in_a.map);
  answer.contact_count = first.contact_count;
  answer.points_tested = first.points_tested;
  answer.F_Bo_A = first.F_M;
  if (!a_in_b) return answer;

  const OneWayResult second = queryOneWay(*a_in_b, X_AB.inverse(), Vec3::Zero(), settings);
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

/// Runs and times the queries, each pose `repeats` times.
void runPoses(const std::vector<Pose>& poses, std::size_t repeats, const OneWay& b_in_a,
              const std::optional<OneWay>& a_in_b, const QuerySettings& settings, const Progress& progress,
              QueryAnswer& answer) {
  std::vector<double> us;
  us.reserve(repeats * poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    progress("querying", static_cast<double>(i) / static_cast<double>(poses.size()));
    PoseAnswer pose;
    for (std::size_t k = 0; k < repeats; ++k) {
      const auto begun = Clock::now();
      pose = queryAt(poses[i], b_in_a, a_in_b, settings);
      us.push_back(secondsSince(begun) * 1e6);
    }
    answer.poses.push_back(pose);
  }
  answer.time = summary(us);
}

int runQuery(const QueryArguments& given) {
  if (!(given.stiffness_N_per_m3 >= 0) || !std::isfinite(given.stiffness_N_per_m3))
    throw LoadError("", "", "--stiffness must be a finite number of at least 0");
  const Fidelity usual = fidelityFrom(given.fidelity, fidelityPreset("normal"));
  const std::vector<Pose> poses = readPoses(given);
  OutputFile json(given.json, {given.mesh_a, given.mesh_b, given.poses});
  ProgressBar bar;

  Operands operands = loadOperands(given);
  const bool is_two_sided = isTwoSided(operands, usual, given);
  std::optional<NamedMesh> a, b;
  if (operands.mesh_a) a.emplace(NamedMesh{*operands.mesh_a, given.mesh_a});
  if (operands.mesh_b) b.emplace(NamedMesh{*operands.mesh_b, given.mesh_b});
  std::string choice;  // choice of the fidelity in words; the same for A and B if both are meshes
  const auto fidelityOf = [&](const std::optional<NamedMesh>& mesh, const std::optional<NamedMesh>& other) {
    return mesh ? fidelityFrom(given.fidelity, *mesh, other ? &*other : nullptr, choice) : usual;
  };
  Fidelity of_b = fidelityOf(b, a);
  Fidelity of_a = fidelityOf(a, b);
  sayChoice(choice);
  if (operands.mesh_a) warnIfThin(*operands.mesh_a, of_a.voxel_m, given.mesh_a);
  if (is_two_sided) warnIfThin(*operands.mesh_b, of_b.voxel_m, given.mesh_b);
  if (operands.mesh_b && given.fidelity.points > 0)
    of_a.spacing_m = of_b.spacing_m = spacingFor(*operands.mesh_b, given.fidelity.points);
  const std::optional<VoxMapCache> cache = cacheFrom(given.cache);
  const auto mapFor = [&](const Mesh& mesh, const Fidelity& fidelity, const std::string& file) {
    return mapOf(mesh, {.voxel_m = fidelity.voxel_m}, file, cache, bar.progress());
  };
  const auto shellFor = [&](const Mesh& mesh, const Fidelity& fidelity, const std::string& file) {
    return buildPointShell(Solid(mesh, file), {.spacing_m = fidelity.spacing_m}, file, bar.progress());
  };
  const auto begun = Clock::now();
  const OneWay b_in_a = {
      operands.map_a ? std::move(*operands.map_a) : mapFor(*operands.mesh_a, of_a, given.mesh_a),
      operands.shell_b ? std::move(*operands.shell_b) : shellFor(*operands.mesh_b, of_b, given.mesh_b)};
  std::optional<OneWay> a_in_b;
  if (is_two_sided)
    a_in_b =
        OneWay{mapFor(*operands.mesh_b, of_b, given.mesh_b), shellFor(*operands.mesh_a, of_a, given.mesh_a)};

  QueryAnswer answer;
  answer.build_wall_s = secondsSince(begun);
  answer.mesh_a = given.mesh_a;
  answer.mesh_b = given.mesh_b;
  answer.voxel_m = b_in_a.map.voxel_m();
  if (a_in_b) answer.voxel_b_m = a_in_b->map.voxel_m();
  answer.point_spacing_m = b_in_a.shell.spacing_m;
  answer.points_total = b_in_a.shell.size() + (a_in_b ? a_in_b->shell.size() : 0);
  answer.memory_bytes = b_in_a.memoryBytes() + (a_in_b ? a_in_b->memoryBytes() : 0);
  const std::size_t repeats = given.repeats > 0 ? static_cast<std::size_t>(given.repeats)
                                                : std::max<std::size_t>(1, 100 / poses.size());
  runPoses(poses, repeats, b_in_a, a_in_b, {usual.gradient, given.stiffness_N_per_m3}, bar.progress(),
           answer);
  throwIfStopped();
  json.write(toJson(answer));
  bar.clear();

  std::fputs(tableOf(answer).c_str(), stdout);
  std::printf(
      "%s query: voxels of %s mm, %zu points every %s mm, %s MB, built in %s s; a pose took %s us (median)\n",
      is_two_sided ? "two-sided" : "one-sided", fixed(answer.voxel_m * 1e3, 3).c_str(), answer.points_total,
      fixed(answer.point_spacing_m * 1e3, 3).c_str(),
      fixed(static_cast<double>(answer.memory_bytes) * 1e-6, 1).c_str(),
      fixed(answer.build_wall_s, 2).c_str(), fixed(answer.time.p50_us, 1).c_str());
  return kGood;
}

}  // namespace

std::function<int()> addQuery(CLI::App& command) {
  const auto given = std::make_shared<QueryArguments>();
  command
      .add_option("mesh_a", given->mesh_a,
                  "the fixed part: a CAD file, or a level set (.vdb, metres) that is used as its voxmap")
      ->required()
      ->type_name("PART_A");
  command
      .add_option("mesh_b", given->mesh_b,
                  "the moving part: a CAD file, or a pointshell (.ply with normals, metres)")
      ->required()
      ->type_name("PART_B");
  CLI::Option* pose = command.add_option(
      "--pose", given->pose, "x,y,z,qx,qy,qz,qw of B in A, in metres (default: the frames coincide)");
  command.add_option("--poses", given->poses, "file with a pose on each line")
      ->type_name("FILE")
      ->excludes(pose);
  addUnitsOption(command, given->units);
  addFidelityOptions(command, given->fidelity);
  addPointsOption(command, given->fidelity);
  command.add_option("--stiffness", given->stiffness_N_per_m3, "penalty stiffness per area [N/m^3]")
      ->capture_default_str();
  command.add_option("--repeats", given->repeats, "timed runs of each pose (default: 100 runs in all)")
      ->check(CLI::Range(1, 1000000));
  addCacheOption(command, given->cache);
  addJsonOption(command, given->json);
  return [given] { return runQuery(*given); };
}

}  // namespace vps::viewer
