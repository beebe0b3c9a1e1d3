// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>

#include "fits/iso_sizes.h"
#include "known/known_overlap.h"
#include "vps_scenes/scene/number_words.h"

namespace vps::scenes {

namespace {

bool isKind(const KnownPart& of, std::initializer_list<FastenerKind> kinds) {
  return of.shape && std::ranges::find(kinds, of.shape->kind) != kinds.end();
}

std::string sizesOf(const TightHole& hole) {
  return lengthInWords(2 * hole.shaft_m, 2) + " in a hole of " + lengthInWords(2 * hole.hole_m, 2);
}

/// Whether the hole is as much smaller than its shaft as the minor diameter of a thread: of a size of ISO
/// 262, or of any size.
bool isOfThread(const TightHole& hole, bool is_any_size) {
  constexpr double kLeast = 0.05, kMost = 0.25;
  const double share = 1 - hole.hole_m / hole.shaft_m;
  return !metricThreadIn(2 * hole.shaft_m, 2 * hole.hole_m).empty() ||
         (is_any_size && share > kLeast && share < kMost);
}

/// Whether a shaft of the other holes is larger than its hole without being a thread in it.
bool hasOtherOverlap(const std::vector<TightHole>& holes, bool is_any_size) {
  constexpr double kRounding_m = 5e-6;
  return std::ranges::any_of(holes, [&](const TightHole& hole) {
    return hole.shaft_m - hole.hole_m > kRounding_m && !isOfThread(hole, is_any_size);
  });
}

bool contains(const std::string& name, std::initializer_list<const char*> words) {
  std::string lower = name;
  for (char& c : lower)
    c = c == '_' || c == '-' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::any_of(words, [&](const char* word) { return lower.find(word) != std::string::npos; });
}

/// Whether the part has a hole of a metric size, or an internal thread.
bool hasMetricHole(const KnownPart& of) {
  return std::ranges::any_of(of.faces.threads, [](const ThreadFace& face) { return face.is_inside; }) ||
         std::ranges::any_of(of.faces.round, [](const RoundFace& face) {
           return face.is_bore &&
                  (!metricHole(2 * face.radius_m).empty() || !metricSize(2 * face.radius_m).empty());
         });
}

bool isInsert(const KnownPart& of) {
  return contains(of.part.name, {"insert", "heat set", "heatset"}) && hasMetricHole(of);
}

bool isSelfTapping(const KnownPart& of) {
  return contains(of.part.name, {"self tapping", "selftapping", "thread forming", "plastite"}) &&
         isKind(of, {FastenerKind::Screw});
}

/// The hole into which `inner` presses, around which its outside may be larger than the hole by a share of
/// its own diameter. The outside of an insert is often knurled, and need not be a cylinder.
std::optional<TightHole> pressedInto(const KnownPart& inner, const KnownPart& outer, double most_share) {
  for (TightHole hole : holesAround(inner, outer)) {
    hole.shaft_m = hole.hole_m / (1 - most_share);
    if (isOnlyInHole(inner.part, outer.part, hole)) return hole;
  }
  return std::nullopt;
}

}  // namespace

KnownOverlap drawnThread(const KnownPart& a, const KnownPart& b, bool is_declared) {
  for (const auto& [inner, outer] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    std::vector<TightHole> holes = tightHoles(*inner, *outer);
    if (hasOtherOverlap(holes, is_declared)) {
      const auto thread =
          std::ranges::find_if(holes, [](const TightHole& hole) { return isOfThread(hole, false); });
      if (thread == holes.end()) continue;
      return {.words = sizesOf(*thread) + ": the sizes of " +
                       metricThreadIn(2 * thread->shaft_m, 2 * thread->hole_m) +
                       ", but the parts overlap elsewhere too"};
    }
    // All other holes are as wide as their shafts, but for rounding.
    std::erase_if(holes, [&](const TightHole& hole) { return !isOfThread(hole, is_declared); });
    if (holes.empty()) continue;
    // The smallest hole: a shaft that is thinner than it is thinner than all others.
    const TightHole& hole = *std::ranges::min_element(holes, {}, &TightHole::hole_m);
    const std::string name = metricThreadIn(2 * hole.shaft_m, 2 * hole.hole_m);
    const std::string size = name.empty() ? lengthInWords(2 * hole.shaft_m, 2) : name;
    // A head without a drive may be that of a screw that is drawn plain. A pin without a head is no screw: 6
    // mm in a hole of 5 mm has the sizes of M6, and may as well be a mistake.
    const bool is_fastener =
        isKind(*inner, {FastenerKind::Screw, FastenerKind::Stud, FastenerKind::HeadedPin}) ||
        isKind(*outer, {FastenerKind::Nut});
    if (!is_fastener && !hole.is_threaded && !is_declared)
      return {.words = sizesOf(hole) + ": the sizes of " + size +
                       ", but neither part has the shape of a screw or nut; a file of rules can declare a "
                       "thread"};
    if (!isOnlyInHole(inner->part, outer->part, hole))
      return {.words = sizesOf(hole) + ": the sizes of " + size +
                       ", but the parts overlap elsewhere too, or their axes are apart"};
    return {PairState::Thread,
            (is_declared ? std::string("declared as a thread ") : std::string("taken for a thread ")) + size +
                ", drawn as " + (hole.is_threaded ? "a cylinder in one part: " : "cylinders: ") +
                sizesOf(hole),
            inner->part.name, size, 0};
  }
  if (!is_declared) return {};
  return {.words =
              "declared as a thread, but no shaft of one part is in a hole of the other that has its axis "
              "and is smaller by 5 to 25 %"};
}

KnownOverlap formedHole(const KnownPart& a, const KnownPart& b, std::optional<OverlapWish> declared) {
  constexpr double kMostInsert = 0.15, kMostTapping = 0.35;  // assumed: share of the outer diameter
  const auto taken = [&](const char* as, const TightHole& hole) {
    return (declared ? std::string("declared as ") : std::string("taken, by name and shape, for ")) + as +
           " in a smaller hole of " + lengthInWords(2 * hole.hole_m, 2);
  };
  for (const auto& [inner, outer] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    if (declared ? declared == OverlapWish::Insert : isInsert(*inner))
      if (const auto hole = pressedInto(*inner, *outer, kMostInsert))
        return {PairState::Insert, taken("an insert", *hole), inner->part.name, "", 0};
    if (declared ? declared == OverlapWish::SelfTapping : isSelfTapping(*inner))
      if (const auto hole = pressedInto(*inner, *outer, kMostTapping))
        return {PairState::Thread, taken("a self-tapping screw", *hole), inner->part.name, "", 0};
  }
  if (!declared) return {};
  return {.words = std::string("declared as ") + toText(*declared) +
                   ", but no hole was found that has the axis of the other part and is smaller by at most " +
                   (declared == OverlapWish::Insert ? "15" : "35") +
                   " %, or the parts overlap elsewhere too"};
}

}  // namespace vps::scenes
