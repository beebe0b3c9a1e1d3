// SPDX-License-Identifier: BSD-3-Clause
#include "known/judge_known.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <unordered_map>

#include "known/known_overlap.h"
#include "rules/pair_choice.h"

namespace vps::scenes {

const char* toText(OverlapWish wish) {
  constexpr std::array kWords{"thread", "seal", "insert", "self-tapping", "clash"};
  return kWords[static_cast<std::size_t>(wish)];
}

namespace {

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

/// Two parts that clash, and the rule that names them.
struct KnownClash {
  CheckedPair* pair;
  std::size_t a, b;
  const OverlapRule* rule = nullptr;
  KnownOverlap found = {};
};

class Judge {
 public:
  Judge(const std::vector<PlacedSurface>& parts, const FacesOfParts& faces, const OverlapWishes& wishes)
      : parts_(parts), faces_(faces), wishes_(wishes) {}

  void judge(const Progress& progress, CheckResult& result) {
    gather(result);
    findShapes(progress);
    forEachOnCores(clashes_.size(), progress, "recognising threads and inserts",
                   [&](std::size_t i) { clashes_[i].found = fastened(clashes_[i]); });
    judgeSeals();
    for (const KnownClash& clash : clashes_) {
      clash.pair->state = clash.found.state;
      clash.pair->explanation = clash.found.words;
      clash.pair->fastener = clash.found.fastener;
      clash.pair->nominal = clash.found.size;
      clash.pair->squash = clash.found.squash;
    }
  }

 private:
  void gather(CheckResult& result) {
    std::vector<PartNames> names;
    std::unordered_map<std::string_view, std::size_t> index_of;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      names.push_back({parts_[i].name, parts_[i].drawn->within});
      index_of.emplace(parts_[i].name, i);
    }
    std::vector<MatchedPairs> named;
    for (const OverlapRule& rule : wishes_.rules) named.emplace_back(rule.between, names);
    for (CheckedPair& pair : result.pairs) {
      if (!pair.isClash() || pair.is_uncertain) continue;
      KnownClash clash{&pair, index_of.at(pair.a), index_of.at(pair.b)};
      for (std::size_t k = 0; k < named.size() && clash.rule == nullptr; ++k)
        if (named[k].has(clash.a, clash.b)) clash.rule = &wishes_.rules[k];
      const bool is_refused = clash.rule ? clash.rule->kind == OverlapWish::Clash : wishes_.is_strict;
      if (!is_refused) clashes_.push_back(clash);
    }
  }

  void findShapes(const Progress& progress) {
    std::vector<const PartSurface*> surfaces;
    for (const KnownClash& clash : clashes_)
      for (const std::size_t part : {clash.a, clash.b})
        if (shapes_.try_emplace(parts_[part].surface.get()).second)
          surfaces.push_back(parts_[part].surface.get());
    forEachOnCores(surfaces.size(), progress, "finding fasteners", [&](std::size_t i) {
      Shape& shape = shapes_.at(surfaces[i]);
      shape.fastener = fastenerShape(*surfaces[i], faces_.at(surfaces[i]));
      shape.torus = torusOf(*surfaces[i]);
    });
  }

  [[nodiscard]] const std::optional<Torus>& torusOfPart(std::size_t part) const {
    return shapes_.at(parts_[part].surface.get()).torus;
  }

  [[nodiscard]] KnownPart knownPart(std::size_t part) const {
    const PartSurface* surface = parts_[part].surface.get();
    return {parts_[part], faces_.at(surface), shapes_.at(surface).fastener};
  }

  /// What the pair is as a thread, insert or self-tapping screw. The first explanation is kept.
  [[nodiscard]] KnownOverlap fastened(const KnownClash& clash) const {
    if (isSeal(clash)) return {};
    const KnownPart a = knownPart(clash.a), b = knownPart(clash.b);
    const std::optional<OverlapWish> kind = clash.rule ? std::optional(clash.rule->kind) : std::nullopt;
    if (kind == OverlapWish::Insert || kind == OverlapWish::SelfTapping) return formedHole(a, b, kind);
    KnownOverlap best = drawnThread(a, b, kind == OverlapWish::Thread);
    if (best.state != PairState::Clash) return best;
    if (KnownOverlap other = modelledThread(a, b); other.state != PairState::Clash || best.words.empty())
      best = std::move(other);
    if (best.state != PairState::Clash || kind) return best;
    KnownOverlap other = formedHole(a, b, kind);
    return other.state != PairState::Clash || best.words.empty() ? other : best;
  }

  [[nodiscard]] bool isSeal(const KnownClash& clash) const {
    if (clash.rule) return clash.rule->kind == OverlapWish::Seal;
    return torusOfPart(clash.a).has_value() != torusOfPart(clash.b).has_value();
  }

  /// The seal of a pair: its torus, or for a declared one without a torus the part of the smaller volume.
  [[nodiscard]] std::size_t sealOf(const KnownClash& clash) const {
    const bool is_a = torusOfPart(clash.a).has_value();
    if (is_a != torusOfPart(clash.b).has_value()) return is_a ? clash.a : clash.b;
    const auto volumeOf = [&](std::size_t part) {
      return std::abs(massProperties(parts_[part].surface->mesh()).volume_m3);
    };
    return volumeOf(clash.a) <= volumeOf(clash.b) ? clash.a : clash.b;
  }

  /// Judges all pairs of one seal together, since two parts may squash it from two sides.
  void judgeSeals() {
    std::map<std::size_t, std::vector<KnownClash*>> of_seal;
    for (KnownClash& clash : clashes_)
      if (isSeal(clash)) of_seal[sealOf(clash)].push_back(&clash);
    for (const auto& [seal, clashes] : of_seal) {
      pollStop();
      if (torusOfPart(seal))
        judgeTorus(seal, clashes);
      else
        for (KnownClash* clash : clashes) judgeByThickness(seal, *clash);
    }
  }

  void judgeTorus(std::size_t seal, const std::vector<KnownClash*>& clashes) {
    std::vector<Squash> each;
    for (const KnownClash* clash : clashes)
      each.emplace_back(parts_[seal], *torusOfPart(seal), parts_[clash->a == seal ? clash->b : clash->a]);
    Squash all = each.front();
    for (const Squash& one : each) all.add(one);
    for (std::size_t i = 0; i < clashes.size(); ++i) {
      KnownOverlap& found = clashes[i]->found;
      if (!each[i].isAllAround()) {
        found.words = "an O-ring by its shape, but not overlapped evenly all around, as by a groove";
        continue;
      }
      describe(parts_[seal].name, all.share(), *clashes[i], "an O-ring");
    }
  }

  /// A declared seal of another section than a circle: its thickness is four times its volume divided by its
  /// surface, which is exact for a long ring of round or square section.
  void judgeByThickness(std::size_t seal, KnownClash& clash) {
    const Mesh& mesh = parts_[seal].surface->mesh();
    const double thick_m = 4 * std::abs(massProperties(mesh).volume_m3) / area(mesh);
    describe(parts_[seal].name, clash.pair->interference_depth_m / thick_m, clash, "a seal");
  }

  static void describe(const std::string& seal, double share, KnownClash& clash, const char* as) {
    constexpr double kRounding = 5e-3;  // the squash is measured on facets
    const bool has_own_limit = clash.rule && clash.rule->max_squash;
    const double most = has_own_limit ? *clash.rule->max_squash : kMostSquash;
    clash.found.squash = share;
    const std::string words =
        std::string(as) + " that is drawn undeformed, squashed by " + percent(share) + " of its section";
    if (share > most + kRounding) {
      clash.found.words = words + ": more than the " + percent(most) +
                          (has_own_limit ? " of its rule" : " of a static seal (Parker O-Ring Handbook)");
      return;
    }
    clash.found.state = PairState::Seal;
    clash.found.fastener = seal;
    clash.found.words = (clash.rule ? "declared as " : "taken for ") + words;
  }

  const std::vector<PlacedSurface>& parts_;
  const FacesOfParts& faces_;
  const OverlapWishes& wishes_;
  struct Shape {
    std::optional<FastenerShape> fastener;
    std::optional<Torus> torus;
  };
  std::map<const PartSurface*, Shape> shapes_;  ///< of all parts that clash
  std::vector<KnownClash> clashes_;
};

}  // namespace

void judgeByKnowledge(const std::vector<PlacedSurface>& parts, const FacesOfParts& faces,
                      const OverlapWishes& wishes, const Progress& progress, CheckResult& result) {
  Judge(parts, faces, wishes).judge(progress, result);
}

}  // namespace vps::scenes
