// SPDX-License-Identifier: BSD-3-Clause
#include "output/reports.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "output/table.h"
#include "vps_scenes/run/verdict.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

/// A direction as text: "-z" for an axis of the world, else three numbers.
std::string directionText(const Vec3& d) {
  constexpr double kAlong = 1e-6;
  if (d.isZero(0)) return "turn";
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(d[axis]) > 1 - kAlong) return std::string(d[axis] > 0 ? "+" : "-") + "xyz"[axis];
  return fixed(d.x(), 2) + ", " + fixed(d.y(), 2) + ", " + fixed(d.z(), 2);
}

std::string wayText(const scenes::PlannedStep& step) {
  if (step.kind == scenes::WayKind::Screw) return "screw, lead " + fixed(1e3 * step.lead_m, 3) + " mm";
  if (step.kind == scenes::WayKind::Legs) return std::to_string(step.before_W.size()) + " legs";
  return toText(step.kind);
}

std::string needsText(const scenes::PlannedAssembly& assembly, const scenes::PlannedStep& step) {
  std::vector<std::string> before;
  for (const scenes::PlannedOrder& one : assembly.order)
    if (one.after == step.name) before.push_back(one.before);
  return before.empty() ? "" : "after " + listedNames(before);
}

/// Describes the path with the least clearance.
std::string tightestText(const scenes::PlannedAssembly& assembly) {
  const scenes::PlannedStep* tightest = nullptr;
  for (const scenes::PlannedStep& step : assembly.steps)
    if (step.clearance_m && (tightest == nullptr || *step.clearance_m < *tightest->clearance_m))
      tightest = &step;
  if (tightest == nullptr) return "";
  return "The least clearance on a path: '" + tightest->name + "' passes '" + tightest->nearest + "' at " +
         fixed(1e3 * *tightest->clearance_m, 3) + " mm.\n";
}

/// Describes the paths on which facets overlap deeper than they do in the assembly as drawn.
std::string allowanceText(const scenes::PlannedAssembly& assembly) {
  std::vector<std::string> names;
  double most_m = 0;
  for (const scenes::PlannedStep& step : assembly.steps) {
    if (step.allowance_m == 0) continue;
    names.push_back(step.name);
    most_m = std::max(most_m, step.allowance_m);
  }
  if (names.empty()) return "";
  return "On the path of " + listedNames(names) + " facets overlap by up to " + um(most_m) +
         " um more than drawn, which the errors of the meshes and 5 um allow. No path without this overlap "
         "was found: use a finer mesh; a hole may be too small.\n";
}

std::string benchText(const scenes::PlannedAssembly& assembly) {
  std::vector<std::string> left;
  bool is_any = false;
  for (const scenes::PlannedStep& step : assembly.steps) {
    is_any = is_any || step.is_on_bench;
    if (!step.is_on_bench) left.push_back(step.name);
  }
  if (!is_any || left.empty()) return "";
  return "Parts that are not laid out on the bench, because they are covered on all sides when mounted: " +
         listedNames(left) + ".\n";
}

/// A part without a path, and what is proven of it.
std::string blockedText(const scenes::BlockedPart& blocked) {
  const std::string room = ": between the two there is room for " + fixed(1e3 * blocked.moves_m, 3) +
                           " mm and " + fixed(blocked.turns_rad * 180 / std::numbers::pi, 1) +
                           " degrees at most, beyond which they overlap everywhere";
  return "'" + blocked.name + "'" +
         withoutPathWords(blocked,
                          " was not taken off: no path was found, which does not prove that there is none") +
         (blocked.enclosed_by.empty() ? "" : room) + ".\n";
}

std::string assemblyTable(const scenes::PlannedAssembly& assembly) {
  std::string out =
      assembly.name + " begins with '" + assembly.fixed.front() + "' (" + assembly.fixed_reason + ").\n";
  Table table({"step", "<part", "<path", "<moves", "<at target", "passes [mm]", "fit [mm]", "<order"});
  for (std::size_t i = 0; i < assembly.steps.size(); ++i) {
    const scenes::PlannedStep& step = assembly.steps[i];
    const std::string name =
        step.parts.size() == 1 ? step.name : step.name + " (" + listedNames(step.parts) + ")";
    table.add(
        {std::to_string(i + 1), name, wayText(step), directionText(step.insertion_W),
         step.is_carried ? "carried" : "held",
         step.clearance_m ? fixed(1e3 * *step.clearance_m, 3) : "> " + fixed(1e3 * scenes::kNearWay_m, 0),
         step.fit_clearance_m ? fixed(1e3 * *step.fit_clearance_m, 3) : "", needsText(assembly, step)});
  }
  if (!assembly.steps.empty()) out += table.text();
  out += tightestText(assembly);
  out += allowanceText(assembly);
  out += benchText(assembly);
  std::vector<std::string> held;
  for (const scenes::PlannedStep& step : assembly.steps)
    if (!step.is_carried) held.push_back(step.name);
  if (!held.empty())
    out +=
        "Nothing carries " + listedNames(held) +
        "; the hand holds each of these parts until the end of its step. If a fixture holds such a part "
        "afterwards, give the fixture as a part; a part that is not to be assembled gets scenery = true.\n";
  for (const scenes::PlannedStep& step : assembly.steps)
    if (!step.falling.empty())
      out += "Until '" + step.name + "' is in place, nothing carries " + listedNames(step.falling) + ".\n";
  for (const scenes::BlockedPart& blocked : assembly.blocked) out += blockedText(blocked);
  return out;
}

std::size_t partCount(const scenes::PlannedAssembly& whole) {
  std::size_t count = whole.fixed.size() + whole.blocked.size();
  for (const scenes::PlannedStep& step : whole.steps) count += step.parts.size();
  return count;
}

double depthOf(const scenes::PlanResult& plan, const scenes::OverlapChoice& choice) {
  const auto pair = std::ranges::find_if(
      plan.overlaps, [&](const scenes::CheckedPair& one) { return one.a == choice.a && one.b == choice.b; });
  return pair == plan.overlaps.end() ? 0 : pair->interference_depth_m;
}

/// Parts whose drawn overlap is too deep for a fit.
class DrawnThrough {
 public:
  explicit DrawnThrough(const scenes::PlanResult& plan) {
    constexpr double kLeast_m = 0.5e-3;  // assumed: parts that are to be pressed or glued overlap by less
    for (const scenes::OverlapChoice& choice : plan.choices) {
      const double depth_m = depthOf(plan, choice);
      if (choice.kind != scenes::OverlapKind::Clash || depth_m < kLeast_m) continue;
      ++clashes_;
      most_m_ = std::max(most_m_, depth_m);
      join(choice.a, choice.b);
    }
  }
  [[nodiscard]] std::size_t parts() const { return set_of_.size(); }
  [[nodiscard]] std::size_t clashes() const { return clashes_; }
  [[nodiscard]] double most_m() const { return most_m_; }
  /// Number of parts of the largest set that is connected by overlaps too deep for a fit.
  [[nodiscard]] std::size_t largest() const {
    std::map<std::size_t, std::size_t> sizes;
    std::size_t most = 0;
    for (const auto& [name, set] : set_of_) most = std::max(most, ++sizes[set]);
    return most;
  }

 private:
  void join(const std::string& a, const std::string& b) {
    const std::size_t to = set_of_.try_emplace(a, set_of_.size()).first->second;
    const std::size_t from = set_of_.try_emplace(b, set_of_.size()).first->second;
    for (auto& [name, set] : set_of_)
      if (set == from) set = to;
  }

  std::map<std::string, std::size_t> set_of_;
  std::size_t clashes_ = 0;
  double most_m_ = 0;
};

// Files of single parts often have a frame of their own each, so that the parts overlap one another. Models
// that are made for pictures have bodies of several shapes that intersect.
std::string framesText(const scenes::PlanResult& plan) {
  constexpr std::size_t kFewest = 3;  // assumed: an overlap of only two parts is intended
  const DrawnThrough drawn(plan);
  const std::size_t count = drawn.parts(), pairs = count * (count - 1) / 2;
  if (count < kFewest || 2 * count < partCount(plan.assemblies.front())) return "";
  if (2 * drawn.clashes() >= pairs)
    return std::to_string(count) + " parts overlap one another, " + std::to_string(drawn.clashes()) + " of " +
           std::to_string(pairs) +
           " pairs: each part seems to be drawn in a frame of its own. Export the assembly as one "
           "file, or give each part its pose in a scene.\n";
  if (drawn.largest() < kFewest) return "";
  return std::to_string(drawn.largest()) + " parts are connected by overlaps of up to " +
         fixed(1e3 * drawn.most_m(), 3) +
         " mm: bodies seem to be drawn as several shapes that intersect, as for pictures. Join the shapes of "
         "each body by --group 'NAME*' or [[group]] in a scene.\n";
}

}  // namespace

std::string fastenerText(const std::vector<scenes::Fastener>& fasteners) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_words;
  for (const scenes::Fastener& one : fasteners) {
    const auto known = std::ranges::find(by_words, one.words, [](const auto& entry) { return entry.first; });
    if (known == by_words.end())
      by_words.emplace_back(one.words, std::vector<std::string>{one.part});
    else
      known->second.push_back(one.part);
  }
  std::string out;
  for (const auto& [words, parts] : by_words)
    out += "  " + std::to_string(parts.size()) + " x " + words + ": " + listedNames(parts) + "\n";
  return out.empty() ? "" : "Fasteners, by their shapes:\n" + out;
}

std::string planTables(const scenes::PlanResult& plan) {
  std::string out;
  for (const scenes::PlannedAssembly& assembly : plan.assemblies)
    out += (out.empty() ? "" : "\n") + assemblyTable(assembly);
  if (const std::string fasteners = fastenerText(plan.fasteners); !fasteners.empty()) out += "\n" + fasteners;
  if (!plan.choices.empty()) out += "\n";
  out += framesText(plan);
  for (const scenes::OverlapChoice& choice : plan.choices) out += choice.words + ".\n";
  if (plan.cut_motions > 0)
    out += scenes::counted(plan.cut_motions, "straight motion was", "straight motions were") +
           " too long to follow to the end and " + (plan.cut_motions == 1 ? "counts" : "count") +
           " as stopped; a greater --deflection makes such motions shorter.\n";
  for (const scenes::CheckedPair& pair : plan.uncertain)
    out += "It is not known whether '" + pair.a + "' and '" + pair.b +
           "' overlap, because a part has no inside there; their surfaces were used.\n";
  return out;
}

namespace {

/// Whether the fault is one of the path, and not of what carries the part at its end.
bool isOfPath(const scenes::WayFault& fault) {
  return fault.kind != scenes::WayFaultKind::Support;
}

/// "'block' cannot leave 'housing'"
std::string enclosedWords(const scenes::PlanResult& plan) {
  std::string out;
  for (const scenes::PlannedAssembly& assembly : plan.assemblies)
    for (const scenes::BlockedPart& part : assembly.blocked)
      if (!part.enclosed_by.empty())
        out += (out.empty() ? "'" : ", '") + part.name + "' cannot leave '" + part.enclosed_by + "'";
  return out;
}

}  // namespace

scenes::Verdict verdictOf(const scenes::PlanResult& plan, const std::vector<scenes::WayFault>& faults) {
  const bool has_fault = std::ranges::any_of(faults, isOfPath);
  return scenes::worse(plan.verdict(), has_fault ? scenes::Verdict::NotShown : scenes::Verdict::Fits);
}

scenes::Verdict verdictOf(const std::vector<scenes::WayFault>& faults) {
  scenes::Verdict worst = scenes::Verdict::Fits;
  for (const scenes::WayFault& fault : faults)
    worst = scenes::worse(worst, fault.isCertain() ? scenes::Verdict::Blocked : scenes::Verdict::NotShown);
  return worst;
}

std::string planHeadline(const scenes::PlanResult& plan, const std::vector<scenes::WayFault>& faults) {
  std::string out = plan.assembly + ": " + scenes::counted(plan.steps(), "step");
  if (const std::size_t subs = plan.assemblies.size() - 1; subs > 0)
    out += ", " + scenes::counted(subs, "subassembly", "subassemblies");
  const std::size_t blocked = plan.blocked();
  out += blocked == 0 ? std::string(", all parts planned")
                      : ", " + scenes::counted(blocked, "part") + " without a path";
  if (const std::size_t proven = plan.enclosed(); proven > 0)
    out +=
        ", " + (proven == blocked ? "proven" : std::to_string(proven) + " of them proven") + " to have none";
  const auto through = std::ranges::count_if(faults, isOfPath);
  if (through > 0)
    out += ", " + std::to_string(through) + (through == 1 ? " written path" : " written paths") +
           " with a fault";
  switch (verdictOf(plan, faults)) {
    case scenes::Verdict::Fits:
      break;
    case scenes::Verdict::Blocked:
      out += "; blocked: " + enclosedWords(plan);
      break;
    case scenes::Verdict::NotShown:
      out += "; not shown: nothing proves that there are no other paths";
  }
  return out + " in " + fixed(plan.check_wall_s + plan.plan_wall_s, 1) + " s";
}

std::string inWords(const scenes::WayFault& fault) {
  if (fault.kind == scenes::WayFaultKind::Support)
    return "nothing in place carries '" + fault.part +
           "' when it is let go; mount the part that carries it before, or set holds = true in its step";
  if (fault.kind == scenes::WayFaultKind::Clearance) {
    const auto [is, planned] = toldApart(fault.clearance_m, fault.planned_m);
    return "the path of '" + fault.part + "' passes '" + fault.against + "' at " + is + " mm, where " +
           planned + " mm were planned; give other way_points";
  }
  const std::string remedy = fault.kind == scenes::WayFaultKind::Order
                                 ? "; mount '" + fault.against + "' after it, or give other way_points"
                                 : "; give other way_points, or another order";
  const auto [depth, allowed] = toldApart(fault.depth_m, fault.allowed_m);
  return "the path of '" + fault.part + "' leads through '" + fault.against + "', " + depth +
         " mm deep at (" + fixed(1e3 * fault.at_W.x(), 2) + ", " + fixed(1e3 * fault.at_W.y(), 2) + ", " +
         fixed(1e3 * fault.at_W.z(), 2) + ") mm (" + allowed + " mm allowed)" +
         (fault.isCertain() ? "" : ", which the error of the meshes may account for") + remedy;
}

}  // namespace vps::viewer
