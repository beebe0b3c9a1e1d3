// SPDX-License-Identifier: BSD-3-Clause
// What a designer asks of a check: which pairs are measured, which bounds they must keep, and which parts are
// moved first. rules.h and part_moves.h have the functions.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// Pairs of parts, chosen by their names: one part matches `a` and the other part matches `b`, in either
/// order. A pattern is the name of a part, or of an assembly or product that contains the part, and * in it
/// stands for any text.
struct PairPattern {
  std::string a, b;
  std::string place;  ///< where the pattern was written, for messages: "--between pin,bush", "rules.toml:4"
};

/// A pair that was not measured, although the boxes of its parts are near each other.
struct LeftOutPair {
  std::string a, b;
  bool is_ignored = false;  ///< true: a pattern of CheckSettings::ignored; false: none of `between` names it
  std::string reason;       ///< in words: "--ignore pin,bush", or "not among the pairs of --between"
};

/// Bounds that pairs of parts must keep. An empty bound does not apply.
struct CheckRule {
  std::string name;
  std::optional<PairPattern> between;     ///< empty: all pairs that are measured
  std::optional<double> min_clearance_m;  ///< least distance of the surfaces; more than 0
  std::optional<double> max_overlap_m;    ///< greatest depth of an overlap; values below kContactDepth_m mean
                                          ///< kContactDepth_m, since such an overlap counts as contact
  std::optional<double> max_axis_offset_m;  ///< greatest CheckedFit::offset_m of round fits and threads
};

/// What the user says about the overlaps of pairs of parts.
enum class OverlapWish {
  Thread,       ///< a thread that is drawn as cylinders, of any size
  Seal,         ///< a seal that is drawn undeformed
  Insert,       ///< an insert that is pressed or melted into a smaller hole
  SelfTapping,  ///< a screw that forms its thread
  Clash,        ///< none of these, whatever the shapes suggest
};
/// "thread", "seal", "insert", "self-tapping" or "clash".
VPS_SCENES_API const char* toText(OverlapWish wish);

/// A declaration of the user about the overlaps of pairs of parts.
struct OverlapRule {
  PairPattern between;
  OverlapWish kind = OverlapWish::Clash;
  /// Greatest squash of a seal, divided by the width of its section; empty: kMostSquash.
  std::optional<double> max_squash = {};
};

/// How overlaps are judged that a drawing may have on purpose.
struct OverlapWishes {
  std::vector<OverlapRule> rules = {};  ///< the first rule that names a pair counts
  bool is_strict = false;               ///< without a rule, every overlap is a clash, whatever its shape
};

/// The quantity that a rule bounds.
enum class RuleMeasure { Clearance, Overlap, AxisOffset };
/// "clearance", "overlap" or "axis offset".
VPS_SCENES_API const char* toText(RuleMeasure measure);

/// What the check says about a rule and a pair; the greater state is the worse one.
enum class RuleState {
  Kept,
  NotDecided,  ///< the bound is within the error of the measured number, or nothing could be measured
  Broken,
};
/// "kept", "not decided" or "broken".
VPS_SCENES_API const char* toText(RuleState state);

/// The outcome of one bound of a rule, for one pair.
struct RuleOutcome {
  std::string rule;  ///< CheckRule::name
  std::string a, b;  ///< the parts; empty where the rule found nothing to measure
  RuleMeasure measure = RuleMeasure::Clearance;
  /// The measured number; a clearance is negative by the depth of an overlap. NaN where nothing was measured.
  double value_m = 0;
  double error_m = 0;  ///< bound of the error of value_m
  double bound_m = 0;  ///< least clearance, or greatest overlap or axis offset
  RuleState state = RuleState::Kept;
  std::string reason = {};  ///< why the rule is not decided, where the error is not the reason; else empty
  /// By how much the number is on the good side of the bound; negative on the other side.
  [[nodiscard]] double margin_m() const {
    return measure == RuleMeasure::Clearance ? value_m - bound_m : bound_m - value_m;
  }
};

/// How many pairs a rule is about.
struct RuleCount {
  std::string rule;
  std::size_t kept = 0, not_decided = 0, broken = 0;  ///< outcomes, one for each bound and pair
  /// Pairs that keep the rule because their parts are farther apart than the check measures; they have no
  /// outcome of their own.
  std::size_t apart = 0;
  std::size_t left_out = 0;  ///< pairs near each other that were left out of the check, and so not judged
};

/// A displacement of a part from its place in the assembly, before the check.
struct PartMove {
  std::string part;
  Vec3 axis_W = Vec3::UnitX();  ///< unit direction of the displacement, or axis of the rotation
  double by_m = 0;              ///< displacement along axis_W
  double turn_rad = 0;          ///< rotation about the axis through the part's own origin
};

}  // namespace vps::scenes
