// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/fits/check.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>
#include <unordered_map>

#include "check/check_placed.h"
#include "core/machine.h"
#include "fits/fits.h"
#include "fits/press_fit.h"
#include "known/judge_known.h"
#include "pair/pair_measures.h"
#include "proof/places.h"
#include "rules/asked_pairs.h"
#include "surface/few_sides.h"
#include "surface/placed_surface.h"
#include "vps/mesh_repair.h"
#include "vps/stoppable.h"
#include "vps_scenes/fits/rules.h"
#include "vps_scenes/scene/number_words.h"

namespace vps::scenes {

const char* toText(PairState state) {
  switch (state) {
    case PairState::Apart:
      return "apart";
    case PairState::Contact:
      return "contact";
    case PairState::PressFit:
      return "press fit";
    case PairState::Thread:
      return "thread";
    case PairState::Seal:
      return "seal";
    case PairState::Insert:
      return "insert";
    case PairState::Clash:
      return "clash";
  }
  return "";
}

const char* toText(FitKind kind) {
  switch (kind) {
    case FitKind::Shaft:
      return "shaft";
    case FitKind::Key:
      return "key";
    case FitKind::Thread:
      return "thread";
  }
  return "";
}

std::string stateWords(const CheckedPair& pair) {
  const std::string state = pair.is_uncertain ? "not known" : toText(pair.state);
  return pair.state == PairState::Clash && pair.is_allowed ? state + " (allowed)" : state;
}

std::string volumeWords(const CheckedPair& pair) {
  constexpr double kPerCubicMetre = 1e9;
  std::array<char, 64> text{};
  if (pair.volume_error_m3 < pair.interference_volume_m3) {
    std::snprintf(text.data(), text.size(), "%.4f", kPerCubicMetre * pair.interference_volume_m3);
    return text.data();
  }
  const double most_m3 = pair.interference_volume_m3 + pair.volume_error_m3;
  if (!(most_m3 > 0)) return "not known";
  std::snprintf(text.data(), text.size(), "<= %.4g", kPerCubicMetre * most_m3);
  return text.data();
}

std::string standardOf(const CheckedFit& fit) {
  if (fit.isEccentric() && !fit.iso_286.empty())
    return "sizes of " + fit.iso_286 + ", but axes " + lengthInWords(fit.offset_m, 2) + " apart";
  if (fit.kind != FitKind::Thread || !fit.thread.empty()) return fit.iso_286 + fit.thread;
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "lead %.3f mm%s%s", 1e3 * std::abs(fit.lead_m),
                fit.starts > 1 ? (", " + std::to_string(fit.starts) + " starts").c_str() : "",
                fit.lead_m < 0 ? ", left-hand" : "");
  return text.data();
}

std::size_t CheckResult::clashes() const {
  return static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [](const CheckedPair& pair) { return pair.isClash(); }));
}

std::size_t CheckResult::uncertain() const {
  return static_cast<std::size_t>(std::ranges::count(pairs, true, &CheckedPair::is_uncertain));
}

bool CheckResult::isAllIgnored() const {
  return pairs.empty() && std::ranges::find(left_out, true, &LeftOutPair::is_ignored) != left_out.end();
}

bool CheckSettings::isAsked(const std::string& part) const {
  return only_parts.empty() || std::ranges::find(only_parts, part) != only_parts.end();
}

const CheckedPair* CheckResult::deepestClash() const {
  const auto found =
      std::find_if(pairs.begin(), pairs.end(), [](const CheckedPair& pair) { return pair.isClash(); });
  return found == pairs.end() ? nullptr : &*found;
}

Verdict CheckResult::verdict() const {
  if (places.verdict != Verdict::Fits) return places.verdict;
  return uncertain() > 0 || !alone.empty() || isAllIgnored() ? Verdict::NotShown : Verdict::Fits;
}

namespace {

using PartPairs = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<CheckedPair> checkPairs(const std::vector<PlacedSurface>& parts, const AskedPairs& asked,
                                    const Progress& progress) {
  const PartPairs& near = asked.pairs;
  std::vector<std::optional<CheckedPair>> found(near.size());
  forEachOnCores(near.size(), progress, "measuring pairs", [&](std::size_t i) {
    found[i] = checkPair(parts[near[i].first], parts[near[i].second], asked.near_m[i]);
  });
  std::vector<CheckedPair> pairs;
  for (std::optional<CheckedPair>& pair : found)
    if (pair) pairs.push_back(std::move(*pair));
  return pairs;
}

void sortPairs(std::vector<CheckedPair>& pairs) {
  std::stable_sort(pairs.begin(), pairs.end(), [](const CheckedPair& a, const CheckedPair& b) {
    if (a.state != b.state) return a.state > b.state;
    if (a.interference_depth_m != b.interference_depth_m)
      return a.interference_depth_m > b.interference_depth_m;
    return a.clearance_m < b.clearance_m;
  });
}

/// The pairs whose overlap cannot be judged without their fits and faces.
PartPairs pairsToJudge(const std::vector<PlacedSurface>& parts, const std::vector<CheckedPair>& pairs) {
  std::unordered_map<std::string_view, std::size_t> index_of;
  for (std::size_t i = 0; i < parts.size(); ++i) index_of.emplace(parts[i].name, i);
  PartPairs out;
  for (const CheckedPair& pair : pairs)
    if (needsFit(pair) || pair.isClash()) out.emplace_back(index_of.at(pair.a), index_of.at(pair.b));
  return out;
}

/// The faces of all parts of the pairs.
FacesOfParts facesOf(const std::vector<PlacedSurface>& parts, const PartPairs& near,
                     const Progress& progress) {
  std::vector<bool> is_near(parts.size());
  for (const auto& [a, b] : near) is_near[a] = is_near[b] = true;
  FacesOfParts faces;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (is_near[i]) faces.try_emplace(parts[i].surface.get());
  std::vector<FacesOfParts::value_type*> own;
  for (auto& of_surface : faces) own.push_back(&of_surface);
  forEachOnCores(own.size(), progress, "finding round and flat faces",
                 [&](std::size_t i) { own[i]->second = fitFaces(*own[i]->first); });
  return faces;
}

std::vector<CheckedFit> checkFits(const std::vector<PlacedSurface>& parts, const PartPairs& near,
                                  const FacesOfParts& faces, const Progress& progress) {
  std::vector<std::vector<CheckedFit>> found(near.size());
  forEachOnCores(near.size(), progress, "finding fits", [&](std::size_t i) {
    const auto [a, b] = near[i];
    const FittedPart of_a{parts[a], faces.at(parts[a].surface.get())},
        of_b{parts[b], faces.at(parts[b].surface.get())};
    appendShaftFits(of_a, of_b, found[i]);
    appendKeyFits(of_a, of_b, found[i]);
    appendThreadFits(of_a, of_b, found[i]);
  });
  std::vector<CheckedFit> fits;
  for (const std::vector<CheckedFit>& of_pair : found)
    fits.insert(fits.end(), of_pair.begin(), of_pair.end());
  return fits;
}

/// Names of the parts whose boxes are near no other box; all parts if no two parts are near each other.
std::vector<std::string> partsAlone(const std::vector<PlacedSurface>& parts, const CheckResult& result,
                                    const CheckSettings& settings) {
  // assumed: a part of an assembly has a neighbour nearer than this, the default of --near
  constexpr double kNeighbour_m = 1e-3;
  std::vector<std::string> alone;
  // A designer who chooses pairs asks about these pairs, whether they are near each other or not.
  if (parts.size() < 2 || !settings.between.empty()) return alone;
  std::vector<bool> has_neighbour(parts.size());
  for (const auto& [a, b] : nearPairs(parts, std::max(settings.near_m, kNeighbour_m)))
    has_neighbour[a] = has_neighbour[b] = true;
  const bool is_none_near = result.pairs.empty() && result.left_out.empty() && settings.only_parts.empty() &&
                            settings.near_m >= kNeighbour_m;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if ((is_none_near || !has_neighbour[i]) && settings.isAsked(parts[i].name))
      alone.push_back(parts[i].name);
  return alone;
}

CheckedPart describePart(const PlacedSurface& part) {
  CheckedPart out;
  out.name = part.name;
  const Mesh& mesh = part.surface->mesh();
  out.triangles = mesh.triangles.size();
  for (std::uint32_t i = 0; i < out.triangles; ++i)
    out.chord_error_m = std::max(out.chord_error_m, part.surface->chord_m(i));
  const MeshReport& report = part.surface->solid().report();
  out.no_inside = part.surface->noInside();
  if (!part.drawn->chord_m) out.read_as = fewSidesWords(*part.surface);
  out.within = part.drawn->within;
  if (!report.isClosed() || part.surface->solid().isByWinding()) out.mesh_faults = describe(report);
  return out;
}

}  // namespace

CheckResult checkAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                          const CheckSettings& settings, const Progress& progress) {
  const StoppableWork stoppable(progress, "preparing the parts");
  const double begun_s = wallSeconds();
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, progress);
  const double prepare_s = wallSeconds() - begun_s;
  CheckResult result = checkPlaced(name, placed, settings, progress);
  result.prepare_wall_s = prepare_s;
  return result;
}

CheckResult checkPlaced(const std::string& name, const std::vector<PlacedSurface>& placed,
                        const CheckSettings& settings, const Progress& progress) {
  const StoppableWork stoppable(progress, "measuring pairs");
  CheckResult result;
  result.assembly = name;
  result.near_m = settings.near_m;
  result.between = settings.between;
  result.ignored = settings.ignored;
  for (const PlacedSurface& part : placed)
    result.moves.insert(result.moves.end(), part.drawn->moves.begin(), part.drawn->moves.end());
  double begun_s = wallSeconds();
  const auto lap_s = [&] {
    const double before_s = begun_s;
    begun_s = wallSeconds();
    return begun_s - before_s;
  };
  AskedPairs asked = askedPairs(placed, settings);
  result.left_out = std::move(asked.left_out);
  result.pairs = checkPairs(placed, asked, progress);
  result.pairs_wall_s = lap_s();
  const PartPairs fitted = settings.has_fits ? asked.pairs : pairsToJudge(placed, result.pairs);
  const FacesOfParts faces = facesOf(placed, fitted, progress);
  result.fits = checkFits(placed, fitted, faces, progress);
  removeFalseFits(result);
  judgeByFits(placed, result);
  judgeByKnowledge(placed, faces, settings.overlaps, progress, result);
  sortPairs(result.pairs);
  result.fits_wall_s = lap_s();
  if (settings.has_fits && settings.has_places && settings.only_parts.empty())
    result.places = freePlaces(placed, result, progress);
  else if (result.clashes() > 0)
    result.places = {Verdict::NotShown, {}, "places without overlap were not searched for", {}};
  result.places_wall_s = lap_s();
  if (!settings.has_fits) result.fits.clear();
  if (settings.has_sections) result.sections = checkSections(placed, result, progress);
  result.plane_sections = planeSections(placed, settings.planes, progress);
  if (settings.has_maps) result.maps = clearanceMaps(placed, result, settings.near_m, progress);
  result.pictures_wall_s = lap_s();
  for (const PlacedSurface& part : placed) result.parts.push_back(describePart(part));
  result.alone = partsAlone(placed, result, settings);
  judgeRules(settings.rules, result);
  if (settings.has_play) checkPlay(placed, result, settings, progress);
  result.play_wall_s = lap_s();
  return result;
}

std::vector<DrawnPart> drawnParts(const ImportedCad& cad) {
  std::vector<DrawnPart> parts;
  for (const ImportedPart& part : cad.parts)
    parts.push_back({.name = part.name,
                     .mesh = part.mesh,
                     .X_WP = part.X_WP,
                     .chord_m = part.deflection_m,
                     .rounding_m = part.rounding_m,
                     .within = part.within});
  return parts;
}

std::vector<DrawnPart> drawnParts(const Scene& scene) {
  std::vector<DrawnPart> parts;
  for (const ScenePart& part : scene.parts)
    parts.push_back({part.part.name, part.part.mesh, part.X_WP, part.deflection_m, part.allow_overlap,
                     part.press_fit_m, part.youngs_modulus_Pa, part.poissons_ratio,
                     part.part.material.friction, part.rounding_m, part.is_fixed, part.within});
  for (const SceneStep& step : scene.steps) parts[step.part].X_WP = placeOf(step);
  return parts;
}

}  // namespace vps::scenes
