// SPDX-License-Identifier: BSD-3-Clause
#include "overlaps/drawn_overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace vps::scenes {

namespace {

/// Description of a key, if the part is a bar with flat sides that is clearly longer than wide; otherwise
/// empty.
std::string keyWords(const PartSurface& part) {
  constexpr double kFilled =
      0.8;  // share of its box that a key fills: round ends take a fifth of a box that is as long as wide
  constexpr double kLeastLength = 1.2,
                   kMostFlatness = 4;  // assumed: the keys of DIN 6885 are up to 1.8 times as wide as high
  std::array<double, 3> size_m = {part.box().size().x(), part.box().size().y(), part.box().size().z()};
  const double volume_m3 = std::abs(massProperties(part.mesh()).volume_m3);
  if (volume_m3 < kFilled * part.box().size().prod()) return "";
  std::ranges::sort(size_m);
  if (size_m[2] < kLeastLength * size_m[1] || size_m[1] > kMostFlatness * size_m[0]) return "";
  char words[80];
  std::snprintf(words, sizeof words, "key %.4g x %.4g x %.4g mm", 1e3 * size_m[1], 1e3 * size_m[0],
                1e3 * size_m[2]);
  return words;
}

}  // namespace

std::vector<Fastener> fastenersIn(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                                  const std::vector<std::optional<FastenerShape>>& shapes) {
  std::set<std::string> in_bore;
  std::map<std::string, std::set<std::string>> keyed;  // by inner part: the parts that hold it by a key fit
  for (const CheckedFit& fit : checked.fits) {
    if (fit.kind == FitKind::Shaft) in_bore.insert(fit.shaft);
    if (fit.kind == FitKind::Key) keyed[fit.shaft].insert(fit.bore);
  }
  std::vector<Fastener> out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string& name = parts[i].name;
    if (shapes[i]) {
      if (shapes[i]->kind != FastenerKind::Pin || in_bore.contains(name))
        out.push_back({name, shapes[i]->kind, shapes[i]->words});
      continue;
    }
    const auto in = keyed.find(name);
    if (in == keyed.end() || in->second.size() < 2) continue;
    if (const std::string words = keyWords(*parts[i].surface); !words.empty())
      out.push_back({name, FastenerKind::Key, words});
  }
  return out;
}

}  // namespace vps::scenes
