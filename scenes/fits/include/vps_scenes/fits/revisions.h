// SPDX-License-Identifier: BSD-3-Clause
// The difference between two revisions of an assembly: parts, clearances, fits, play and verdict.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// A checked assembly; both members are referred to, not copied.
struct CheckedAssembly {
  const std::vector<DrawnPart>& parts;
  const CheckResult& result;  ///< of checkAssembly() for these parts
};

/// Size and content of a part's shape.
struct ShapeMeasures {
  double volume_m3 = 0;        ///< enclosed by the mesh; without a meaning for a mesh that is not closed
  double area_m2 = 0;          ///< area of the surface
  Vec3 size_m = Vec3::Zero();  ///< size of the box along the axes of the part's frame
};

/// A part that differs between the revisions. At least one of the flags is set.
struct PartChange {
  std::string name;      ///< name in the new revision; empty for a part that was removed
  std::string old_name;  ///< name in the old revision; empty for a part that was added
  bool is_added = false, is_removed = false;
  bool is_moved = false;     ///< a corner of the part's box moved by more than the rounding of the files
  bool is_reshaped = false;  ///< the surfaces differ by more than the errors of both meshes
  bool is_renamed = false;   ///< another name, and not only another counter of equal parts ("bolt_2")
  /// Displacement of the middle of the part's box and rotation vector about it, from the old to the new
  /// place. For a part of another shape it is the motion that covers the two surfaces best: none, or the
  /// motion of the part's frame.
  Vec3 by_W = Vec3::Zero(), turn_W = Vec3::Zero();
  double most_m = 0;  ///< greatest displacement of a corner of the part's box
  std::optional<ShapeMeasures> old_shape = {}, new_shape = {};  ///< empty where the part does not exist
  /// Greatest distance of a point of one revision's surface from the surface of the other one, after the
  /// motion, and how much greater it may be at most, since the search ended. 0 for a part of equal shape.
  double deviation_m = 0, deviation_error_m = 0;
  /// Answers for the part alone (partVerdict()); NotShown where the part does not exist.
  Verdict old_verdict = Verdict::NotShown, new_verdict = Verdict::NotShown;
  [[nodiscard]] bool isVerdictChanged() const {
    return !is_added && !is_removed && old_verdict != new_verdict;
  }
};

/// Two parts, both in both revisions, whose distance, overlap or state differs.
struct PairChange {
  std::string a, b;  ///< names in the new revision
  /// States in words, as stateWords(); "not near" for a pair that a check did not report, since it is farther
  /// apart than CheckSettings::near_m.
  std::string old_state, new_state;
  /// Clearance, or minus the depth of the overlap; not a number for a pair that is not near.
  double old_gap_m = std::numeric_limits<double>::quiet_NaN();
  double new_gap_m = std::numeric_limits<double>::quiet_NaN();
  double error_m = 0;  ///< sum of the errors of both gaps
};

/// A fit of two parts, both in both revisions, that is new, gone or different.
struct FitChange {
  FitKind kind = FitKind::Shaft;
  std::string shaft, bore;  ///< names in the new revision
  bool is_added = false, is_removed = false;
  std::string old_standard = {}, new_standard = {};                         ///< as standardOf(); empty: none
  double old_shaft_m = 0, new_shaft_m = 0, old_bore_m = 0, new_bore_m = 0;  ///< 0 where there is no fit
  double old_clearance_m = 0, new_clearance_m = 0;                          ///< diametral
  double error_m = 0;  ///< sum of the errors of both clearances
};

/// A direction in which a part moves or turns by another amount before it touches another part.
struct PlayChange {
  std::string part;                   ///< name in the new revision
  std::string direction;              ///< "+x": motion along; "about +x": rotation about an axis of the play
  bool is_turn = false;               ///< true: the play is in radians
  double old_play = 0, new_play = 0;  ///< [m] or [rad]; infinite where nothing stops the part
  double error = 0;                   ///< sum of the errors of both
};

/// What differs between two revisions of an assembly. All lists are empty if nothing does.
struct RevisionChanges {
  std::string old_assembly, new_assembly;  ///< names of the two assemblies
  Verdict old_verdict = Verdict::NotShown, new_verdict = Verdict::NotShown;
  std::vector<PartChange> parts;  ///< in the order of the new revision, then removed ones as in the old one
  std::vector<PairChange> pairs;  ///< in the order of the new check, then pairs that are not near any more
  std::vector<FitChange> fits;    ///< in the order of the new check, then fits that are gone
  std::vector<PlayChange> play;
  [[nodiscard]] bool isSame() const {
    return parts.empty() && pairs.empty() && fits.empty() && play.empty() && old_verdict == new_verdict;
  }
};

/// The answer for one part alone: the worst verdict of the groups of overlapping parts that contain it
/// (CheckedPlaces::groups); NotShown for a part that is near no other one, or one whose overlap with another
/// part is not known; else Fits.
VPS_SCENES_API Verdict partVerdict(const CheckResult& result, const std::string& part);

/// Compares two revisions of an assembly, which should be checked with the same settings.
///
/// Parts are matched by name. Parts of equal shape whose names differ only by the counter that the import
/// adds ("bolt", "bolt_2") count as instances of one name and are matched by place, the nearest first, so
/// that their order in the file does not matter. Then a part that has the shape and the place of a part of
/// another name is that part, renamed.
///
/// A number counts as changed if it differs by more than the sum of its errors in both checks and by more
/// than 0.01 um, the last digit that is printed. Play is compared for parts of equal axes. Fits and pairs of
/// parts that were added or removed are not listed: the list of parts has them. The same bits on any number
/// of threads.
VPS_SCENES_API RevisionChanges compareRevisions(const CheckedAssembly& before, const CheckedAssembly& after,
                                                const Progress& progress = {});

}  // namespace vps::scenes
