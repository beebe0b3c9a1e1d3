// SPDX-License-Identifier: BSD-3-Clause
#include "world/drawn_targets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fits/fits.h"
#include "scene/steps.h"
#include "text/words.h"
#include "vps/mesh.h"
#include "vps/mesh_repair.h"
#include "vps/pose.h"
#include "vps/stoppable.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {

namespace {

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

/// For each vertex, one representative of all vertices that facets connect to it.
std::vector<std::uint32_t> shellOfVertices(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const auto& t : mesh.triangles)
    for (const int k : {1, 2}) parent[rootOf(parent, t[k])] = rootOf(parent, t[0]);
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = rootOf(parent, v);
  return parent;
}

/// Signed solid angle of the triangle seen from the origin (van Oosterom and Strackee 1983).
double solidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Marks shells with an edge that does not have exactly two facets.
std::vector<bool> openShells(const Mesh& mesh, const std::vector<std::uint32_t>& shell) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  std::vector<bool> is_open(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end - i != 2) is_open[shell[edges[i].first]] = true;
    i = end;
  }
  return is_open;
}

/// Winding number of each shell around p: -1 for a shell that faces inwards and encloses p.
std::vector<double> turnsAround(const Vec3& p, const Mesh& mesh, const std::vector<std::uint32_t>& shell) {
  std::vector<double> turns(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles)
    turns[shell[t[0]]] +=
        solidAngle(mesh.vertices[t[0]] - p, mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p) /
        (4 * std::numbers::pi);
  return turns;
}

/// True if a part lies in a cavity of another part, that is, inside a closed shell that faces inwards. The
/// test takes up to 32 vertices of the part; it does not detect a cavity that several parts form, or a cavity
/// whose wall all of these vertices touch. O(n log n), plus the other part's triangles for each of these
/// vertices.
/// @param X_OP  pose of the part in the other part's frame
bool isInClosedRoom(const Mesh& part, const Mesh& other, const Pose& X_OP) {
  if (!isWithin(moved(bounds(part), X_OP), bounds(other))) return false;
  const Mesh solid = repairMesh(welded(other)).solid;
  const std::vector<std::uint32_t> shell = shellOfVertices(solid);
  if (std::all_of(shell.begin(), shell.end(), [&](std::uint32_t s) { return s == shell[0]; })) return false;
  const std::vector<bool> is_open = openShells(solid, shell);
  constexpr std::size_t kVertices = 32;
  const std::size_t stride = std::max<std::size_t>(1, part.vertices.size() / kVertices);
  for (std::size_t i = 0; i < part.vertices.size(); i += stride) {
    const std::vector<double> turns = turnsAround(X_OP * part.vertices[i], solid, shell);
    for (std::size_t v = 0; v < turns.size(); ++v)
      if (turns[v] < -0.9 && !is_open[v]) return true;
  }
  return false;
}

struct InPlace {
  const ScenePart* part;
  Pose X_WP;
};

std::vector<InPlace> inPlaceBefore(const Scene& scene, std::size_t step) {
  std::vector<InPlace> parts;
  for (const auto& [part, X_WP] : partsInPlace(scene, step)) parts.push_back({&scene.parts[part], X_WP});
  return parts;
}

bool contains(const std::vector<InPlace>& parts, const std::string& name) {
  return std::any_of(parts.begin(), parts.end(), [&](const InPlace& p) { return p.part->part.name == name; });
}

/// The other part of a pair or fit, if the pair consists of `part` and a part in place; else null.
const std::string* otherOf(const std::string& part, const std::string& a, const std::string& b,
                           const std::vector<InPlace>& in_place) {
  if (a != part && b != part) return nullptr;
  const std::string& other = a == part ? b : a;
  return contains(in_place, other) ? &other : nullptr;
}

/// Decides about a part that overlaps `blocked_by` as drawn. It is blocked unless the search has found places
/// at which no parts overlap at all. overlap_doubt tells a block that is not proven for the places near by.
void judgeByPlaces(const CheckedPlaces& places, StepResult& step) {
  const Judgement found = judgeOverlap(places, step.part);
  if (isGood(found.verdict)) {
    step.blocked_by = step.reason = "";
    step.blocked_at_W = Vec3::Zero();
    step.blocked_depth_m = step.blocked_error_m = 0;
    return;
  }
  if (found.verdict == Verdict::Blocked)
    step.reason += "; " + found.reason;
  else
    step.overlap_doubt = found.reason;
}

void findOverlap(const CheckResult& checked, const std::vector<InPlace>& in_place, StepResult& step) {
  for (const CheckedPair& pair : checked.pairs) {
    const std::string* other = otherOf(step.part, pair.a, pair.b, in_place);
    if (other == nullptr) continue;
    // A part that is taken off overlaps other parts as drawn, within the error of the meshes.
    if (step.is_taken_off && !pair.isClash())
      step.penetration_limit_m = std::max(step.penetration_limit_m, pair.interference_depth_m);
    if (!pair.isClash() || pair.interference_depth_m <= step.blocked_depth_m) continue;
    step.blocked_by = *other;
    step.blocked_at_W = pair.at_W;
    step.blocked_depth_m = pair.interference_depth_m;
    step.blocked_error_m = pair.error_m;
  }
  if (step.blocked_by.empty()) return;
  step.reason = overlapReason(step.blocked_by, step.blocked_depth_m, step.blocked_error_m, step.blocked_at_W);
  judgeByPlaces(checked.places, step);
}

/// Adds up the forces that press the part in.
void findPressFit(const CheckResult& checked, const std::vector<InPlace>& in_place, StepResult& step) {
  for (const CheckedFit& fit : checked.fits)
    if (fit.press && otherOf(step.part, fit.shaft, fit.bore, in_place) != nullptr)
      step.press_needed_N += fit.press->declared_force_N;
}

void findClosedRoom(const Scene& scene, const SceneStep& planned, const std::vector<InPlace>& in_place,
                    StepResult& step) {
  for (const InPlace& other : in_place) {
    const Mesh& mesh = scene.parts[planned.part].part.mesh;
    const auto isInside = [&](const Pose& X_WP) {
      return isInClosedRoom(mesh, other.part->part.mesh, other.X_WP.inverse() * X_WP);
    };
    const bool starts_inside = isInside(planned.X_WP_start);
    if (!starts_inside && !isInside(planned.X_WP_target)) continue;
    step.blocked_by = other.part->part.name;
    step.blocked_at_W = (starts_inside ? planned.X_WP_start : planned.X_WP_target) * mesh.vertices.front();
    step.reason = closedRoomReason(step.blocked_by, starts_inside);
    return;
  }
}

/// The later part that aligns this part; empty if there is none. A part without a fit with the parts in place
/// is put down by sight. A later part that fits into such a part moves the part to its target: a bolt through
/// a bracket that lies on a plate finds the plate's hole, and moves the bracket.
std::string alignedBy(const CheckResult& checked, const Scene& scene, std::size_t step,
                      const std::vector<InPlace>& in_place, const std::string& part) {
  const auto fits = [&](const std::string& other) {
    return std::ranges::any_of(checked.fits, [&](const CheckedFit& fit) {
      return (fit.shaft == part && fit.bore == other) || (fit.bore == part && fit.shaft == other);
    });
  };
  if (std::ranges::any_of(in_place, [&](const InPlace& other) { return fits(other.part->part.name); }))
    return {};
  for (std::size_t i = step + 1; i < scene.steps.size(); ++i)
    if (const std::string& later = scene.parts[scene.steps[i].part].part.name; fits(later)) return later;
  return {};
}

double knownError_m(const ScenePart& part) {
  return part.deflection_m.value_or(0) + part.rounding_m;
}

/// Reason for doubt where the meshes differ from the exact faces by more than the clearance of the parts;
/// empty if there is none. Penetrations up to 10 um count as contact, so smaller clearances are not doubted.
/// Flat faces are exact after an import with the requested accuracy, so a part without a fit is doubted only
/// where the error exceeds its tolerance.
std::string meshDoubt(const Scene& scene, const CheckResult& checked, const std::vector<InPlace>& in_place,
                      const SceneStep& planned, const StepResult& step) {
  constexpr double kContact_m = 10e-6;
  const ScenePart& own = scene.parts[planned.part];
  std::string doubt;
  double most_m = 0;
  const auto partOf = [&](const std::string& mate) -> const ScenePart& {
    return *std::ranges::find(in_place, mate, [](const InPlace& p) { return p.part->part.name; })->part;
  };
  const auto errorWith = [&](const std::string& mate) {
    return knownError_m(own) + knownError_m(partOf(mate));
  };
  const auto consider = [&](const std::string& mate, double clearance_m, const char* what) {
    const ScenePart& other = partOf(mate);
    const ScenePart& worse = knownError_m(own) >= knownError_m(other) ? own : other;
    const double error_m = errorWith(mate);
    // The error counts twice, for both sides, since a clearance is a difference of diameters.
    if (2 * error_m <= std::max(clearance_m, kContact_m) || error_m <= most_m) return;
    most_m = error_m;
    doubt = "the mesh of '" + worse.part.name + "' differs by up to " + lengthInWords(knownError_m(worse)) +
            " from its exact faces, which its " + what + " '" + mate + "' (" + lengthInWords(clearance_m) +
            ") does not allow; give a finer --deflection, or a better file of that part";
  };
  bool has_fit = false;
  for (const CheckedFit& fit : checked.fits) {
    const std::string* mate = otherOf(step.part, fit.shaft, fit.bore, in_place);
    if (mate == nullptr) continue;
    has_fit = true;
    const double found_m = std::max(0.0, fit.diametral_clearance_m);
    consider(*mate, planned.clearance_m > 0 ? planned.clearance_m : found_m, "clearance in");
  }
  if (has_fit) return doubt;
  for (const CheckedPair& pair : checked.pairs) {
    const std::string* mate = otherOf(step.part, pair.a, pair.b, in_place);
    // Faces cannot touch if they are farther apart than the errors of both meshes.
    if (mate == nullptr || pair.clearance_m > errorWith(*mate)) continue;
    consider(*mate, planned.clearance_m > 0 ? planned.clearance_m : 2 * step.tolerance_m, "place at");
  }
  return doubt;
}

/// Reason for doubt where no other part is near the target that the part could fit.
std::string aloneDoubt(const CheckResult& checked, const StepResult& step) {
  const bool is_alone = std::ranges::find(checked.alone, step.part) != checked.alone.end();
  if (!is_alone || step.is_taken_off) return {};
  return "at its target the part is nowhere near another part, so that nothing shows that it fits; check "
         "whether the parts are laid out side by side, or each in a frame of its own";
}

/// Moves the parts that the check has moved to clear all overlaps: each to its new place, and the rest of its
/// path by the same displacement, without its small turn, which would be large at a distant start.
void moveTargets(const CheckedPlaces& places, Scene& scene, std::vector<StepResult>& steps) {
  if (places.verdict != Verdict::Fits) return;
  for (const MovedPart& moved : places.moved)
    for (std::size_t i = 0; i < steps.size(); ++i) {
      SceneStep& step = scene.steps[i];
      if (steps[i].part != moved.name) continue;
      Pose& place = step.takes_off ? step.X_WP_start : step.X_WP_target;
      Pose& end = step.takes_off ? step.X_WP_target : step.X_WP_start;
      place = moved.X_WP;
      end.p += moved.by_W;
      for (Pose& point : step.way_points) point.p += moved.by_W;
      steps[i].moved_m = moved.most_m;
    }
}

double toleranceOf(const CheckResult& checked, const std::vector<InPlace>& in_place, const SceneStep& planned,
                   const std::string& part) {
  if (planned.tolerance_m > 0) return planned.tolerance_m;
  if (planned.is_held || planned.motion == StepMotion::Screw) return kSightTolerance_m;
  std::optional<double> clearance_m;
  if (planned.clearance_m > 0) clearance_m = planned.clearance_m;
  for (const CheckedFit& fit : checked.fits) {
    if (planned.clearance_m > 0 || otherOf(part, fit.shaft, fit.bore, in_place) == nullptr) continue;
    const double found_m = std::max(0.0, fit.diametral_clearance_m);
    clearance_m = std::min(clearance_m.value_or(found_m), found_m);
  }
  return clearance_m ? fitTolerance_m(*clearance_m) : kSightTolerance_m;
}

}  // namespace

std::vector<double> drawnTolerances_m(const Scene& scene) {
  const CheckResult checked = checkAssembly(scene.name, drawnParts(scene), {.has_play = false});
  std::vector<double> out;
  for (std::size_t i = 0; i < scene.steps.size(); ++i)
    out.push_back(toleranceOf(checked, inPlaceBefore(scene, i), scene.steps[i],
                              scene.parts[scene.steps[i].part].part.name));
  return out;
}

std::vector<StepResult> checkDrawnTargets(Scene& scene, const Progress& progress,
                                          std::shared_ptr<const CheckResult>* to) {
  CheckSettings settings;
  settings.has_play = false;
  // Scenery takes no part in the run, so that the places which the check finds with it say nothing.
  settings.has_places = std::ranges::none_of(scene.parts, &ScenePart::is_scenery);
  const auto kept =
      std::make_shared<const CheckResult>(checkAssembly(scene.name, drawnParts(scene), settings, progress));
  if (to != nullptr) *to = kept;
  const StoppableWork work(progress, "checking the targets", 1);
  const CheckResult& checked = *kept;
  std::vector<StepResult> steps(scene.steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const SceneStep& planned = scene.steps[i];
    const std::vector<InPlace> in_place = inPlaceBefore(scene, i);
    steps[i].part = scene.parts[planned.part].part.name;
    steps[i].is_taken_off = planned.takes_off;
    steps[i].tolerance_m = toleranceOf(checked, in_place, planned, steps[i].part);
    findOverlap(checked, in_place, steps[i]);
    steps[i].aligned_by = alignedBy(checked, scene, i, in_place, steps[i].part);
    steps[i].mesh_doubt = meshDoubt(scene, checked, in_place, planned, steps[i]);
    if (steps[i].mesh_doubt.empty()) steps[i].mesh_doubt = aloneDoubt(checked, steps[i]);
    findPressFit(checked, in_place, steps[i]);
    if (steps[i].blocked_by.empty()) findClosedRoom(scene, planned, in_place, steps[i]);
    if (!steps[i].blocked_by.empty()) steps[i].verdict = judge({.blocked = steps[i].reason}).verdict;
  }
  moveTargets(checked.places, scene, steps);
  return steps;
}

}  // namespace vps::scenes
