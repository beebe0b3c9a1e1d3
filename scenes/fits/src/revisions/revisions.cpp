// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/fits/revisions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "revisions/match_parts.h"
#include "revisions/measured_changes.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

Verdict partVerdict(const CheckResult& result, const std::string& part) {
  const auto worse = [](Verdict a, Verdict b) {
    if (a == Verdict::Blocked || b == Verdict::Blocked) return Verdict::Blocked;
    return a == Verdict::NotShown || b == Verdict::NotShown ? Verdict::NotShown : Verdict::Fits;
  };
  Verdict verdict = Verdict::Fits;
  bool is_in_group = false;
  for (const CheckedGroup& group : result.places.groups)
    if (std::ranges::find(group.parts, part) != group.parts.end()) {
      verdict = worse(verdict, group.verdict);
      is_in_group = true;
    }
  for (const CheckedPair& pair : result.pairs) {
    if (pair.a != part && pair.b != part) continue;
    // Without a search for places, a clash is in no group.
    if (pair.is_uncertain || (pair.isClash() && !is_in_group)) verdict = worse(verdict, Verdict::NotShown);
  }
  const bool is_alone = std::ranges::find(result.alone, part) != result.alone.end();
  return is_alone ? worse(verdict, Verdict::NotShown) : verdict;
}

namespace {

std::vector<RevisedPart> revisedParts(const CheckedAssembly& assembly, const Progress& progress) {
  std::unordered_map<std::string_view, double> chord_m;
  for (const CheckedPart& part : assembly.result.parts) chord_m.emplace(part.name, part.chord_error_m);
  std::vector<RevisedPart> parts(assembly.parts.size());
  forEachOnCores(parts.size(), progress, "comparing revisions", [&](std::size_t i) {
    const DrawnPart& part = assembly.parts[i];
    const auto found = chord_m.find(part.name);
    parts[i] = revisedPart(part, found == chord_m.end() ? 0 : found->second);
  });
  return parts;
}

/// Fills the motion of a change; true if a corner of the part's box moves by more than the rounding.
bool isMoved(const RevisedPart& before, const RevisedPart& after, const Pose& motion_W, PartChange& change) {
  const Pose X_WP = before.drawn->X_WP;
  const Box box_P = bounds(before.drawn->mesh);
  const Vec3 middle_W = X_WP * box_P.center();
  double most_m = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p = box_P.min;
    for (int axis = 0; axis < 3; ++axis)
      if ((corner >> axis & 1) != 0) p[axis] = box_P.max[axis];
    p = X_WP * p;
    most_m = std::max(most_m, (motion_W * p - p).norm());
  }
  if (most_m <= rounding_m(before, after)) return false;
  change.by_W = motion_W * middle_W - middle_W;
  change.turn_W = rotationVector(motion_W.R);
  change.most_m = most_m;
  return true;
}

struct Compared {
  std::vector<PartChange> changes;  ///< of the parts of the new revision
  PartMatches matches;
};

Compared compareParts(const CheckedAssembly& before, const CheckedAssembly& after, const Progress& progress) {
  const std::vector<RevisedPart> old_parts = revisedParts(before, progress),
                                 new_parts = revisedParts(after, progress);
  const std::vector<std::string> old_instance = instanceNames(old_parts),
                                 new_instance = instanceNames(new_parts);
  const std::vector<std::optional<std::size_t>> match = matchParts(old_parts, new_parts);
  Compared out;
  out.changes.resize(new_parts.size());
  out.matches.motion_W.resize(new_parts.size());
  forEachOnCores(new_parts.size(), progress, "comparing shapes", [&](std::size_t j) {
    PartChange& change = out.changes[j];
    change.name = new_parts[j].drawn->name;
    change.new_shape = new_parts[j].shape;
    change.new_verdict = partVerdict(after.result, change.name);
    change.is_added = !match[j];
    if (!match[j]) return;
    const RevisedPart& old_part = old_parts[*match[j]];
    change.old_name = old_part.drawn->name;
    change.old_shape = old_part.shape;
    change.old_verdict = partVerdict(before.result, change.old_name);
    change.is_renamed = change.name != change.old_name && new_instance[j] != old_instance[*match[j]];
    const ShapeChange shape = shapeChange(old_part, new_parts[j]);
    change.is_reshaped = shape.is_reshaped;
    change.deviation_m = shape.deviation_m;
    change.deviation_error_m = shape.deviation_error_m;
    change.is_moved = isMoved(old_part, new_parts[j], shape.motion_W, change);
    out.matches.motion_W[j] = shape.motion_W;
  });
  std::vector<bool> is_kept(old_parts.size());
  for (std::size_t j = 0; j < new_parts.size(); ++j) {
    if (!match[j]) continue;
    is_kept[*match[j]] = true;
    out.matches.new_of.emplace(out.changes[j].old_name, j);
    out.matches.old_of.emplace(out.changes[j].name, *match[j]);
  }
  for (std::size_t i = 0; i < old_parts.size(); ++i) {
    if (is_kept[i]) continue;
    PartChange& change = out.changes.emplace_back();
    change.old_name = old_parts[i].drawn->name;
    change.old_shape = old_parts[i].shape;
    change.is_removed = true;
    change.old_verdict = partVerdict(before.result, change.old_name);
  }
  return out;
}

}  // namespace

RevisionChanges compareRevisions(const CheckedAssembly& before, const CheckedAssembly& after,
                                 const Progress& progress) {
  RevisionChanges out;
  out.old_assembly = before.result.assembly;
  out.new_assembly = after.result.assembly;
  out.old_verdict = before.result.verdict();
  out.new_verdict = after.result.verdict();
  Compared compared = compareParts(before, after, progress);
  out.pairs = pairChanges(before, after, compared.matches);
  out.fits = fitChanges(before, after, compared.matches);
  out.play = playChanges(before, after, compared.matches);
  std::erase_if(compared.changes, [](const PartChange& c) {
    return !c.is_added && !c.is_removed && !c.is_moved && !c.is_reshaped && !c.is_renamed &&
           !c.isVerdictChanged();
  });
  out.parts = std::move(compared.changes);
  return out;
}

}  // namespace vps::scenes
