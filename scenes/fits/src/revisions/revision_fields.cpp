// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "vps_scenes/fits/revision_fields.h"

namespace vps::scenes {

namespace {

std::string numberWords(double value, const char* form) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), form, value);
  return text.data();
}

std::string fromTo(const std::string& before, const std::string& after) {
  return before == after ? after : before + " -> " + after;
}

/// "+x" for an axis of the world; else the components.
std::string preciseDirection(const Vec3& direction) {
  constexpr double kAligned = 1e-4;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(direction[axis]) > 1 - kAligned * kAligned)
      return std::string(direction[axis] > 0 ? "+" : "-") + "xyz"[axis];
  std::string out = "(";
  for (int axis = 0; axis < 3; ++axis) out += numberWords(direction[axis], axis < 2 ? "%.3f, " : "%.3f)");
  return out;
}

std::string verdictText(Verdict verdict) {
  return verdict == Verdict::NotShown ? "not shown" : toText(verdict);
}

}  // namespace

std::string changeWords(const PartChange& change) {
  std::string out;
  for (const auto& [is, word] :
       std::initializer_list<std::pair<bool, const char*>>{{change.is_added, "added"},
                                                           {change.is_removed, "removed"},
                                                           {change.is_renamed, "renamed"},
                                                           {change.is_moved, "moved"},
                                                           {change.is_reshaped, "other shape"},
                                                           {change.isVerdictChanged(), "other verdict"}})
    if (is) out += (out.empty() ? "" : ", ") + std::string(word);
  return out;
}

std::string nameWords(const PartChange& change) {
  if (change.name.empty()) return change.old_name;
  if (change.old_name.empty() || change.old_name == change.name) return change.name;
  return change.name + " (was " + change.old_name + ")";
}

std::string motionWords(const PartChange& change) {
  if (!change.is_moved) return "";
  constexpr double kShown_m = 0.05e-6, kShown_rad = 5e-8;
  std::string out;
  if (const double by_m = change.by_W.norm(); by_m > kShown_m)
    out = numberWords(1e3 * by_m, "%.4f mm along ") + preciseDirection(change.by_W / by_m);
  if (const double turn_rad = change.turn_W.norm(); turn_rad > kShown_rad)
    out += (out.empty() ? "turned by " : ", turned by ") +
           numberWords(turn_rad * 180 / std::numbers::pi, "%.4f deg about ") +
           preciseDirection(change.turn_W / turn_rad);
  return out;
}

std::string shapeWords(const PartChange& change) {
  if (!change.is_reshaped || !change.old_shape || !change.new_shape) return "";
  const ShapeMeasures &before = *change.old_shape, &after = *change.new_shape;
  std::string out = "surfaces up to " + numberWords(1e6 * change.deviation_m, "%.1f um apart");
  if (change.deviation_error_m > 0.05 * change.deviation_m)
    out += numberWords(1e6 * (change.deviation_m + change.deviation_error_m), " (at most %.1f)");
  const auto add = [&](const std::string& what, double was, double is, const char* unit) {
    const std::string old_text = numberWords(was, "%.6g"), new_text = numberWords(is, "%.6g");
    if (old_text != new_text) out += "; " + what + " " + old_text + " -> " + new_text + unit;
  };
  add("volume", 1e9 * before.volume_m3, 1e9 * after.volume_m3, " mm3");
  add("area", 1e6 * before.area_m2, 1e6 * after.area_m2, " mm2");
  for (int axis = 0; axis < 3; ++axis)
    add(std::string("size in ") + "xyz"[axis], 1e3 * before.size_m[axis], 1e3 * after.size_m[axis], " mm");
  return out;
}

std::string verdictWords(const PartChange& change) {
  return change.isVerdictChanged() ? fromTo(verdictText(change.old_verdict), verdictText(change.new_verdict))
                                   : "";
}

std::string stateChangeWords(const PairChange& change) {
  return fromTo(change.old_state, change.new_state);
}

std::string gapWords(const PairChange& change) {
  const auto words = [](double gap_m) {
    return std::isfinite(gap_m) ? numberWords(1e6 * gap_m, "%.2f") : std::string("-");
  };
  return fromTo(words(change.old_gap_m), words(change.new_gap_m));
}

std::string standardWords(const FitChange& change) {
  const auto words = [](const std::string& standard) { return standard.empty() ? "none" : standard; };
  if (change.is_added) return "new: " + words(change.new_standard);
  if (change.is_removed) return "gone: " + words(change.old_standard);
  return fromTo(words(change.old_standard), words(change.new_standard));
}

std::string sizeWords(const FitChange& change) {
  const auto words = [&](double before_m, double after_m) {
    if (change.is_added) before_m = after_m;
    if (change.is_removed) after_m = before_m;
    return fromTo(numberWords(1e3 * before_m, "%.4f"), numberWords(1e3 * after_m, "%.4f"));
  };
  return words(change.old_shaft_m, change.new_shaft_m) + " in " + words(change.old_bore_m, change.new_bore_m);
}

std::string clearanceWords(const FitChange& change) {
  const double before_m = change.is_added ? change.new_clearance_m : change.old_clearance_m,
               after_m = change.is_removed ? change.old_clearance_m : change.new_clearance_m;
  return fromTo(numberWords(1e6 * before_m, "%.2f"), numberWords(1e6 * after_m, "%.2f"));
}

std::string playChangeWords(const PlayChange& change) {
  const auto words = [&](double play) {
    if (!std::isfinite(play)) return std::string("free");
    return change.is_turn ? numberWords(1e3 * play, "%.2f") : numberWords(1e6 * play, "%.1f");
  };
  return fromTo(words(change.old_play), words(change.new_play)) + (change.is_turn ? " mrad" : " um");
}

}  // namespace vps::scenes
