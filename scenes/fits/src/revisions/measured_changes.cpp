// SPDX-License-Identifier: BSD-3-Clause
#include "revisions/measured_changes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace vps::scenes {

namespace {

/// Numbers that differ by less than the last digit that is printed look equal, whatever their errors.
constexpr double kPrinted_m = 0.01e-6;
constexpr double kPrinted_rad = 1e-5;

bool isChanged(double before, double after, double error, double printed) {
  if (std::isinf(before) || std::isinf(after)) return std::isinf(before) != std::isinf(after);
  return std::abs(after - before) > error + printed;
}

double gap_m(const CheckedPair& pair) {
  return pair.interference_depth_m > 0 ? -pair.interference_depth_m : pair.clearance_m;
}

/// The name in the new revision of a part of the old one; null if the part was removed.
const std::string* newNameOf(const std::string& old_name, const CheckedAssembly& after,
                             const PartMatches& matches) {
  const auto found = matches.new_of.find(old_name);
  return found == matches.new_of.end() ? nullptr : &after.parts[found->second].name;
}

constexpr const char* kNotNear = "not near";

/// Whether a pair that only one check reports is nearer than near_m by more than its error, so that the pair
/// did not only pass the limit.
bool isWellWithin(const CheckedPair& pair, double near_m) {
  return gap_m(pair) + pair.error_m + kPrinted_m < near_m;
}

using NamePair = std::pair<std::string, std::string>;
NamePair sortedNames(const std::string& a, const std::string& b) {
  return a < b ? NamePair(a, b) : NamePair(b, a);
}

}  // namespace

std::vector<PairChange> pairChanges(const CheckedAssembly& before, const CheckedAssembly& after,
                                    const PartMatches& matches) {
  std::map<NamePair, const CheckedPair*> old_pairs;  // by the names in the new revision
  std::vector<std::pair<NamePair, const CheckedPair*>> in_order;
  for (const CheckedPair& pair : before.result.pairs) {
    const std::string *a = newNameOf(pair.a, after, matches), *b = newNameOf(pair.b, after, matches);
    if (a == nullptr || b == nullptr) continue;
    old_pairs.emplace(sortedNames(*a, *b), &pair);
    in_order.emplace_back(NamePair(*a, *b), &pair);
  }
  std::vector<PairChange> out;
  for (const CheckedPair& pair : after.result.pairs) {
    if (!matches.old_of.contains(pair.a) || !matches.old_of.contains(pair.b)) continue;
    PairChange change{pair.a, pair.b, kNotNear, stateWords(pair)};
    change.new_gap_m = gap_m(pair);
    change.error_m = pair.error_m;
    const auto found = old_pairs.find(sortedNames(pair.a, pair.b));
    if (found == old_pairs.end()) {
      if (isWellWithin(pair, before.result.near_m)) out.push_back(change);
      continue;
    }
    const CheckedPair& old_pair = *found->second;
    old_pairs.erase(found);
    change.old_state = stateWords(old_pair);
    change.old_gap_m = gap_m(old_pair);
    change.error_m += old_pair.error_m;
    if (change.old_state != change.new_state ||
        isChanged(change.old_gap_m, change.new_gap_m, change.error_m, kPrinted_m))
      out.push_back(change);
  }
  for (const auto& [names, pair] : in_order) {
    if (!old_pairs.contains(sortedNames(names.first, names.second)) ||
        !isWellWithin(*pair, after.result.near_m))
      continue;
    PairChange change{names.first, names.second, stateWords(*pair), kNotNear};
    change.old_gap_m = gap_m(*pair);
    change.error_m = pair->error_m;
    out.push_back(change);
  }
  return out;
}

namespace {

/// An old fit with the names of the new revision, where the motion of its shaft takes it.
struct OldFit {
  const CheckedFit* fit;
  std::string shaft, bore;
  Vec3 at_W;
};

/// The nearest old fit of the same parts and kind that is left; -1 if there is none.
std::ptrdiff_t nearestFit(const CheckedFit& fit, const std::vector<OldFit>& old_fits) {
  std::ptrdiff_t nearest = -1;
  double least_m = 0;
  for (std::size_t i = 0; i < old_fits.size(); ++i) {
    const OldFit& old_fit = old_fits[i];
    if (old_fit.fit == nullptr || old_fit.fit->kind != fit.kind || old_fit.shaft != fit.shaft ||
        old_fit.bore != fit.bore)
      continue;
    // Two fits of one pair may have one middle, as the journals of a stepped shaft; their sizes differ.
    const double far_m = (old_fit.at_W - fit.at_W).norm() + std::abs(old_fit.fit->shaft_m - fit.shaft_m);
    if (nearest >= 0 && far_m >= least_m) continue;
    nearest = static_cast<std::ptrdiff_t>(i);
    least_m = far_m;
  }
  return nearest;
}

void describeNew(FitChange& change, const CheckedFit& fit) {
  change.new_standard = standardOf(fit);
  change.new_shaft_m = fit.shaft_m;
  change.new_bore_m = fit.bore_m;
  change.new_clearance_m = fit.diametral_clearance_m;
  change.error_m += fit.error_m;
}

void describeOld(FitChange& change, const CheckedFit& fit) {
  change.old_standard = standardOf(fit);
  change.old_shaft_m = fit.shaft_m;
  change.old_bore_m = fit.bore_m;
  change.old_clearance_m = fit.diametral_clearance_m;
  change.error_m += fit.error_m;
}

bool isChanged(const FitChange& change) {
  return change.old_standard != change.new_standard ||
         isChanged(change.old_clearance_m, change.new_clearance_m, change.error_m, kPrinted_m) ||
         isChanged(change.old_shaft_m, change.new_shaft_m, change.error_m, kPrinted_m) ||
         isChanged(change.old_bore_m, change.new_bore_m, change.error_m, kPrinted_m);
}

}  // namespace

std::vector<FitChange> fitChanges(const CheckedAssembly& before, const CheckedAssembly& after,
                                  const PartMatches& matches) {
  std::vector<OldFit> old_fits;
  for (const CheckedFit& fit : before.result.fits) {
    const std::string *shaft = newNameOf(fit.shaft, after, matches),
                      *bore = newNameOf(fit.bore, after, matches);
    if (shaft == nullptr || bore == nullptr) continue;
    old_fits.push_back({&fit, *shaft, *bore, matches.motion_W[matches.new_of.at(fit.shaft)] * fit.at_W});
  }
  std::vector<FitChange> out;
  for (const CheckedFit& fit : after.result.fits) {
    if (!matches.old_of.contains(fit.shaft) || !matches.old_of.contains(fit.bore)) continue;
    FitChange change{fit.kind, fit.shaft, fit.bore};
    describeNew(change, fit);
    const std::ptrdiff_t nearest = nearestFit(fit, old_fits);
    change.is_added = nearest < 0;
    if (nearest >= 0)
      describeOld(change, *std::exchange(old_fits[static_cast<std::size_t>(nearest)].fit, nullptr));
    if (change.is_added || isChanged(change)) out.push_back(change);
  }
  for (const OldFit& left : old_fits) {
    if (left.fit == nullptr) continue;
    FitChange change{left.fit->kind, left.shaft, left.bore};
    change.is_removed = true;
    describeOld(change, *left.fit);
    out.push_back(change);
  }
  return out;
}

namespace {

/// Axes of the play are those of the tightest fit. If these differ, the numbers are not those of the same
/// directions.
bool hasEqualAxes(const CheckedPart& before, const CheckedPart& after, const Pose& motion_W) {
  constexpr double kSameAxes = 1e-4;  // assumed: play changes by less than this share
  return (motion_W.R * before.play_axes_W - after.play_axes_W).cwiseAbs().maxCoeff() < kSameAxes;
}

constexpr std::array kDirections = {"+x", "-x", "+y", "-y", "+z", "-z"};

}  // namespace

std::vector<PlayChange> playChanges(const CheckedAssembly& before, const CheckedAssembly& after,
                                    const PartMatches& matches) {
  std::unordered_map<std::string, const CheckedPart*> old_parts;
  for (const CheckedPart& part : before.result.parts) old_parts.emplace(part.name, &part);
  std::vector<PlayChange> out;
  for (const CheckedPart& part : after.result.parts) {
    const auto match = matches.old_of.find(part.name);
    if (match == matches.old_of.end()) continue;
    const std::string& old_name = before.parts[match->second].name;
    const auto found = old_parts.find(old_name);
    if (found == old_parts.end()) continue;
    const CheckedPart& old_part = *found->second;
    const Pose& motion_W = matches.motion_W[matches.new_of.at(old_name)];
    if (!part.play || !old_part.play || !hasEqualAxes(old_part, part, motion_W)) continue;
    const auto compare = [&](const std::string& direction, bool is_turn, double was, double is,
                             double error) {
      if (isChanged(was, is, error, is_turn ? kPrinted_rad : kPrinted_m))
        out.push_back({part.name, direction, is_turn, was, is, error});
    };
    for (std::size_t k = 0; k < kDirections.size(); ++k)
      compare(kDirections[k], false, old_part.play->m[k], part.play->m[k],
              old_part.play->error_m[k] + part.play->error_m[k]);
    for (std::size_t k = 0; k < kDirections.size(); ++k)
      compare(std::string("about ") + kDirections[k], true, old_part.play->rad[k], part.play->rad[k],
              old_part.play->error_rad[k] + part.play->error_rad[k]);
  }
  return out;
}

}  // namespace vps::scenes
