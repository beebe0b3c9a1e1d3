// SPDX-License-Identifier: BSD-3-Clause
#include "rules/pair_choice.h"

#include <algorithm>

#include "import/part_names.h"
#include "scene/scene_file_keys.h"
#include "vps/errors.h"

namespace vps::scenes {

namespace {

bool isMatch(const PartNames& part, const std::string& pattern) {
  return import::matchesPattern(part.name, pattern) ||
         std::ranges::any_of(part.within, [&](const std::string& assembly) {
           return import::matchesPattern(assembly, pattern);
         });
}

std::vector<bool> matching(const std::string& pattern, const PairPattern& of,
                           const std::vector<PartNames>& parts) {
  std::vector<bool> out(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) out[i] = isMatch(parts[i], pattern);
  if (std::ranges::find(out, true) != out.end()) return out;
  std::vector<std::string> names;
  for (const PartNames& part : parts) names.push_back(part.name);
  throw LoadError(of.place, "", "'" + pattern + "' matches no part" + didYouMean(pattern, names));
}

std::vector<MatchedPairs> matchedPairs(const std::vector<PairPattern>& patterns,
                                       const std::vector<PartNames>& parts) {
  std::vector<MatchedPairs> out;
  for (const PairPattern& pattern : patterns) out.emplace_back(pattern, parts);
  return out;
}

}  // namespace

MatchedPairs::MatchedPairs(const PairPattern& pattern, const std::vector<PartNames>& parts)
    : is_a_(matching(pattern.a, pattern, parts)), is_b_(matching(pattern.b, pattern, parts)) {
  if (is_a_ != is_b_ || std::ranges::count(is_a_, true) > 1) return;
  const auto only = static_cast<std::size_t>(std::ranges::find(is_a_, true) - is_a_.begin());
  throw LoadError(pattern.place, "",
                  "matches only the part '" + parts[only].name + "'; a pair needs two parts");
}

MatchedPairs MatchedPairs::all(const std::vector<PartNames>& parts) {
  MatchedPairs out;
  out.is_a_.assign(parts.size(), true);
  out.is_b_ = out.is_a_;
  return out;
}

PairChoice::PairChoice(const std::vector<PairPattern>& between, const std::vector<PairPattern>& ignored,
                       const std::vector<PartNames>& parts)
    : between_(matchedPairs(between, parts)),
      ignored_(matchedPairs(ignored, parts)),
      ignored_patterns_(ignored) {
  for (const PartNames& part : parts) names_.push_back(part.name);
}

bool PairChoice::has(std::size_t i, std::size_t k) const {
  const auto isOf = [&](const MatchedPairs& pairs) { return pairs.has(i, k); };
  return (between_.empty() || std::ranges::any_of(between_, isOf)) && std::ranges::none_of(ignored_, isOf);
}

LeftOutPair PairChoice::leftOut(std::size_t i, std::size_t k) const {
  LeftOutPair out{names_[i], names_[k], false, "not among the pairs that were asked for"};
  const auto ignored =
      std::ranges::find_if(ignored_, [&](const MatchedPairs& pairs) { return pairs.has(i, k); });
  if (ignored == ignored_.end()) return out;
  out.is_ignored = true;
  out.reason = ignored_patterns_[static_cast<std::size_t>(ignored - ignored_.begin())].place;
  return out;
}

}  // namespace vps::scenes
