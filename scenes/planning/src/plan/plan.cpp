// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/planning/plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

#include "check/check_placed.h"
#include "core/machine.h"
#include "order/proven_enclosed.h"
#include "order/take_apart.h"
#include "overlaps/drawn_overlaps.h"
#include "surface/placed_surface.h"
#include "vps/errors.h"
#include "vps/stoppable.h"
#include "ways/resting.h"
#include "ways/way.h"

namespace vps::scenes {

const char* toText(WayKind kind) {
  switch (kind) {
    case WayKind::Straight:
      return "straight";
    case WayKind::Screw:
      return "screw";
    case WayKind::Legs:
      return "legs";
  }
  return "";
}

const char* toText(OrderReason reason) {
  return reason == OrderReason::Way ? "way" : "carries";
}

std::size_t PlanResult::steps() const {
  return std::accumulate(assemblies.begin(), assemblies.end(), std::size_t{0},
                         [](std::size_t sum, const PlannedAssembly& one) { return sum + one.steps.size(); });
}

std::size_t PlanResult::blocked() const {
  return std::accumulate(
      assemblies.begin(), assemblies.end(), std::size_t{0},
      [](std::size_t sum, const PlannedAssembly& one) { return sum + one.blocked.size(); });
}

std::size_t PlanResult::enclosed() const {
  std::size_t count = 0;
  for (const PlannedAssembly& assembly : assemblies)
    for (const BlockedPart& part : assembly.blocked) count += part.enclosed_by.empty() ? 0 : 1;
  return count;
}

Verdict PlanResult::verdict() const {
  if (enclosed() > 0) return Verdict::Blocked;
  return blocked() > 0 ? Verdict::NotShown : Verdict::Fits;
}

namespace {

/// Distance that parts move on their last leg until they have left the boxes of all held parts, plus half of
/// their own length. The distance of a screw is measured from its target without turning: a hand starts the
/// screw outside its mate and turns it onto its thread.
double leavingDistance(const PairMotions& motions, const Removal& removal,
                       const std::vector<std::size_t>& held) {
  const Vec3& d = removal.way.legs.back().motion.direction;
  const Pose X_W = removal.way.kind == WayKind::Screw ? Pose() : cornersOf(removal.way).back();
  double far_m = 0, own_m = 0;
  for (const std::size_t part : removal.parts) {
    const PlacedSurface placed = displaced(motions.parts()[part], X_W);
    own_m = std::max(own_m, d.cwiseAbs().dot(placed.box_W.size()));
    for (const std::size_t h : held)
      far_m = std::max(far_m, leavingDistance_m(placed.box_W, motions.parts()[h].box_W, d));
  }
  return far_m + 0.5 * own_m;
}

class Planner {
 public:
  Planner(const PairMotions& motions, const Progress& progress, PlanFindings* found)
      : motions_(motions), progress_(progress), found_(found) {
    for (const PlacedSurface& part : motions.parts()) names_.insert(part.name);
  }

  /// Plans the members, then the subassemblies that the plan needs.
  void plan(const std::string& name, const std::vector<std::size_t>& members, std::vector<std::size_t> fixed,
            std::string reason, std::vector<PlannedAssembly>& out) {
    if (fixed.empty()) {
      const BasePart base = proposedBase(motions_, members);
      fixed = {base.part};
      reason = base.reason;
    }
    const Disassembly apart =
        takeApart(motions_, members, fixed, progress_, [&](const Removal& removal) { note(removal); });
    PlannedAssembly planned{name, {}, std::move(reason), {}, {}, {}};
    for (const std::size_t part : apart.fixed) planned.fixed.push_back(nameOf(part));
    for (const Disassembly::Blocked& blocked : apart.blocked) {
      planned.fixed.push_back(nameOf(blocked.part));
      planned.blocked.emplace_back();
      planned.blocked.back().name = nameOf(blocked.part);
      planned.blocked.back().is_searched = blocked.is_searched;
      for (const std::size_t by : blocked.by) planned.blocked.back().by.push_back(nameOf(by));
    }
    std::vector<std::string> names;
    std::vector<std::size_t> held = apart.fixed;
    for (const Disassembly::Blocked& blocked : apart.blocked) held.push_back(blocked.part);
    for (std::size_t i = apart.removals.size(); i-- > 0;) {
      planned.steps.push_back(stepOf(apart.removals[i], held));
      names.insert(names.begin(), planned.steps.back().name);
      held.insert(held.end(), apart.removals[i].parts.begin(), apart.removals[i].parts.end());
    }
    planned.order = precedence(motions_, apart, names);
    out.push_back(std::move(planned));
    for (std::size_t i = apart.removals.size(); i-- > 0;)
      if (apart.removals[i].parts.size() > 1) plan(names[i], apart.removals[i].parts, {}, "", out);
  }

 private:
  void note(const Removal& removal) {
    if (found_ == nullptr) return;
    std::string names;
    for (const std::size_t part : removal.parts) names += (names.empty() ? "" : ", ") + nameOf(part);
    found_->taken_off.push_back(std::move(names));
  }
  [[nodiscard]] const std::string& nameOf(std::size_t part) const { return motions_.parts()[part].name; }

  std::string newName() {
    for (int i = 1;; ++i)
      if (const std::string name = "subassembly_" + std::to_string(i); names_.insert(name).second)
        return name;
  }

  PlannedStep stepOf(const Removal& removal, const std::vector<std::size_t>& held) {
    const Way& way = removal.way;
    PlannedStep step;
    step.name = removal.parts.size() == 1 ? nameOf(removal.parts.front()) : newName();
    for (const std::size_t part : removal.parts) step.parts.push_back(nameOf(part));
    step.kind = way.kind;
    step.lead_m = way.lead_m;
    step.allowance_m = way.allowance_m;
    step.is_carried = removal.is_carried && (removal.parts.size() > 1 ||
                                             (!sinksFromItsPlace(motions_, removal.parts.front(), held) &&
                                              !leansInHole(motions_, removal.parts.front(), held) &&
                                              !tipsOver(motions_, removal.parts.front(), held)));
    for (const std::size_t part : removal.falling) step.falling.push_back(nameOf(part));
    const Vec3& out_W = way.legs.back().motion.direction;
    const double out_m = leavingDistance(motions_, removal, held);
    step.insertion_W = way.kind == WayKind::Legs ? insertionOf(way) : Vec3(-out_W);
    if (way.kind == WayKind::Screw) {  // the virtual hand turns a screw without way points
      step.before_W = {Pose::translation(out_m * out_W)};
      return step;
    }
    if (way.kind == WayKind::Straight && removal.parts.size() == 1) {
      const Vec3 aside_m = toMostRoom_m(motions_, removal.parts.front(), held, out_W);
      step.before_W = {Pose::translation(out_m * out_W + aside_m)};
      if (!aside_m.isZero(0)) step.before_W.push_back(Pose::translation(aside_m));
      return step;
    }
    const std::vector<Pose> corners = cornersOf(way);
    std::vector<Vec3> centers_W;
    for (const std::size_t of : removal.parts) {
      const PlacedSurface& part = motions_.parts()[of];
      centers_W.push_back(part.X_WP * part.surface->solid().mass().com);
    }
    step.before_W = {Pose::translation(out_m * out_W) * corners.back()};
    for (std::size_t i = corners.size(); i-- > 1;) {
      step.before_W.push_back(corners[i]);
      appendTurn(way.legs[i - 1], corners[i - 1], centers_W, step.before_W);
    }
    return step;
  }

  static Vec3 insertionOf(const Way& way) {
    return way.legs.front().motion.is_turn ? Vec3(Vec3::Zero()) : Vec3(-way.legs.front().motion.direction);
  }

  /// Adds poses along a turn, at most an eighth of a turn apart. The hand moves the centre of what it holds
  /// on a straight line between poses; the poses are close enough to keep the centres of all parts, and so
  /// their common centre, within 2 um of their circles.
  static void appendTurn(const Leg& leg, const Pose& from_W, const std::vector<Vec3>& centers_W,
                         std::vector<Pose>& out) {
    if (!leg.motion.is_turn) return;
    constexpr double kMost_rad = 0.79, kLeast_rad = 0.05, kOff_m = 2e-6;
    double radius_m = 0;
    for (const Vec3& center_W : centers_W)
      radius_m = std::max(radius_m, leg.motion.direction.cross(from_W * center_W - leg.motion.center).norm());
    const double sag_rad = 2 * std::acos(std::max(-1.0, 1 - kOff_m / std::max(radius_m, kOff_m)));
    const int pieces = static_cast<int>(std::ceil(leg.s / std::clamp(sag_rad, kLeast_rad, kMost_rad)));
    for (int k = pieces - 1; k > 0; --k) out.push_back(leg.motion.at(leg.s * k / pieces) * from_W);
  }

  const PairMotions& motions_;
  const Progress& progress_;
  PlanFindings* found_;
  std::set<std::string> names_;
};

/// Saves the motions found so far, also if planning ends by an exception.
class Keeping {
 public:
  Keeping(PairMotions& motions, const PlanSettings& settings) : motions_(motions), found_(settings.found) {
    if (settings.known != nullptr) motions.take(settings.known->motions);
    if (found_ != nullptr) found_->taken_off.clear();
  }
  ~Keeping() {
    if (found_ != nullptr) found_->motions = motions_.found();
  }
  Keeping(const Keeping&) = delete;
  Keeping& operator=(const Keeping&) = delete;

 private:
  const PairMotions& motions_;
  PlanFindings* found_;
};

std::string wordsOf(const CheckedFit& fit) {
  const std::string standard = standardOf(fit);
  return toText(fit.kind) + (standard.empty() ? "" : " " + standard);
}

/// Pairs that `check` found near each other, with the likely directions in which one blocks the other.
std::vector<PlannedContact> contactsOf(const PairMotions& motions, const CheckResult& checked,
                                       const Progress& progress) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < motions.parts().size(); ++i) index[motions.parts()[i].name] = i;
  std::map<std::pair<std::size_t, std::size_t>, PlannedContact> by_pair;
  const auto pairOf = [&](const std::string& a, const std::string& b) -> PlannedContact& {
    const auto key = std::minmax(index.at(a), index.at(b));
    PlannedContact& contact = by_pair[key];
    contact.a = motions.parts()[key.first].name;
    contact.b = motions.parts()[key.second].name;
    return contact;
  };
  for (const CheckedPair& pair : checked.pairs) {
    PlannedContact& contact = pairOf(pair.a, pair.b);
    contact.state = pair.state;
    contact.clearance_m = pair.clearance_m;
  }
  for (const CheckedFit& fit : checked.fits) pairOf(fit.shaft, fit.bore).fits.push_back(wordsOf(fit));
  std::vector<PlannedContact> out;
  for (auto& [key, contact] : by_pair) out.push_back(std::move(contact));
  forEachOnCores(out.size(), progress, "finding blocked directions", [&](std::size_t i) {
    const std::size_t a = index.at(out[i].a), b = index.at(out[i].b);
    for (const std::size_t d : motions.axesOf(a))
      (motions.stops(b, a, d) ? out[i].blocked_W : out[i].free_W).push_back(motions.directions()[d]);
  });
  return out;
}

std::vector<EqualParts> equalParts(const std::vector<PlacedSurface>& parts) {
  std::map<const PartSurface*, std::size_t> known;
  std::vector<EqualParts> out;
  for (const PlacedSurface& part : parts) {
    const auto [at, is_new] = known.try_emplace(part.surface.get(), out.size());
    if (is_new) out.emplace_back();
    out[at->second].names.push_back(part.name);
  }
  std::erase_if(out, [](const EqualParts& one) { return one.names.size() < 2; });
  return out;
}

std::vector<std::size_t> indicesOf(const std::vector<std::string>& names,
                                   const std::vector<DrawnPart>& parts) {
  std::vector<std::size_t> out;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(parts, name, &DrawnPart::name);
    if (found == parts.end())
      throw LoadError("", "", "'" + name + "' should be fixed, but no part has this name");
    out.push_back(static_cast<std::size_t>(found - parts.begin()));
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

PlanResult planAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                        const PlanSettings& settings, const Progress& progress) {
  if (parts.empty()) throw LoadError("", name, "has no parts to plan");
  const std::vector<std::size_t> fixed = indicesOf(settings.fixed, parts);
  const StoppableWork stoppable(progress, "preparing the parts");
  double begun_s = wallSeconds();
  PlanResult result;
  result.assembly = name;
  CheckSettings check;
  check.has_play = false;
  check.overlaps = settings.overlaps;
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, progress);
  const CheckResult checked = checkPlaced(name, placed, check, progress);
  for (const CheckedPair& pair : checked.pairs) {
    if (pair.state >= PairState::PressFit) result.overlaps.push_back(pair);
    if (pair.is_uncertain) result.uncertain.push_back(pair);
  }
  result.check_wall_s = wallSeconds() - begun_s;
  begun_s = wallSeconds();
  const std::vector<std::optional<FastenerShape>> shapes = fastenerShapes(placed, progress);
  result.fasteners = fastenersIn(placed, checked, shapes);
  result.choices = noVolumeChoices(placed, fixed);
  std::ranges::move(overlapChoices(placed, checked, shapes, fixed), std::back_inserter(result.choices));
  std::ranges::move(lineToLineChoices(placed, checked, result.choices), std::back_inserter(result.choices));
  for (const OverlapChoice& choice : result.choices)
    if (choice.kind == OverlapKind::Twice) result.twice.push_back({choice.a, choice.b});
  PairMotions motions(placed, checked, settings.up_W, progress);
  const Keeping keeping(motions, settings);
  std::vector<std::size_t> members(parts.size());
  std::iota(members.begin(), members.end(), std::size_t{0});
  const std::vector<std::size_t> left_out = leftOut(placed, result.choices);
  std::erase_if(members, [&](std::size_t part) {
    return std::ranges::binary_search(left_out, part) && !std::ranges::binary_search(fixed, part);
  });
  Planner(motions, progress, settings.found).plan(name, members, fixed, "as requested", result.assemblies);
  const Placing placing{placed, checked, settings.up_W};
  for (PlannedAssembly& assembly : result.assemblies) {
    if (settings.has_bench) layOnBench(placing, assembly);
    measureWays(placing, assembly, progress);
  }
  proveEnclosed(placed, checked, result.assemblies, progress);
  result.cut_motions = motions.cutMotions();
  result.contacts = contactsOf(motions, checked, progress);
  result.equal = equalParts(placed);
  result.plan_wall_s = wallSeconds() - begun_s;
  return result;
}

PlanResult planAssembly(const Scene& scene, PlanSettings settings, const Progress& progress) {
  if (scene.gravity_W.norm() > 0) settings.up_W = -scene.gravity_W.normalized();
  const std::vector<DrawnPart> drawn = drawnParts(scene);
  std::vector<DrawnPart> parts;
  const bool is_named = !settings.fixed.empty();
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (scene.parts[i].is_scenery) continue;
    parts.push_back(drawn[i]);
    if (!is_named && scene.parts[i].is_fixed) settings.fixed.push_back(drawn[i].name);
  }
  return planAssembly(scene.name, parts, settings, progress);
}

}  // namespace vps::scenes
