// SPDX-License-Identifier: BSD-3-Clause
#include "revisions/match_parts.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>
#include <unordered_map>

namespace vps::scenes {

namespace {

/// "bolt" for "bolt_2" and any greater counter; empty if the name has no counter.
std::string withoutCounter(const std::string& name) {
  const std::size_t at = name.rfind('_');
  if (at == std::string::npos || at == 0 || at + 1 == name.size() || name[at + 1] == '0') return "";
  if (!std::ranges::all_of(name.substr(at + 1), [](unsigned char c) { return std::isdigit(c) != 0; }))
    return "";
  return name.substr(at + 1) == "1" ? "" : name.substr(0, at);
}

double distance_m(const RevisedPart& a, const RevisedPart& b) {
  return (a.box_W.center() - b.box_W.center()).norm();
}

/// Two parts that may be one, ordered by how well they fit.
struct Candidate {
  bool is_other_shape = false;
  long long distance_nm = 0;  ///< rounded, so that places of equal distance are equal
  double turned = 0;  ///< squared difference of the rotations; equal parts about one middle differ in it
  bool is_other_name = false;
  std::size_t before = 0, after = 0;

  [[nodiscard]] auto key() const {
    return std::tuple(is_other_shape, distance_nm, turned, is_other_name, before, after);
  }
};

class Matcher {
 public:
  Matcher(const std::vector<RevisedPart>& before, const std::vector<RevisedPart>& after)
      : before_(before), after_(after), is_taken_(before.size()), found_(after.size()) {}

  /// Matches parts that are left and for which `mayBeOne` is true, the best candidates first.
  template <class MayBeOne>
  void match(const MayBeOne& mayBeOne) {
    std::vector<Candidate> candidates;
    for (std::size_t j = 0; j < after_.size(); ++j) {
      if (found_[j]) continue;
      for (std::size_t i = 0; i < before_.size(); ++i)
        if (!is_taken_[i] && mayBeOne(i, j)) candidates.push_back(candidate(i, j));
    }
    std::ranges::sort(candidates, {}, &Candidate::key);
    for (const Candidate& one : candidates) {
      if (is_taken_[one.before] || found_[one.after]) continue;
      is_taken_[one.before] = true;
      found_[one.after] = one.before;
    }
  }

  [[nodiscard]] std::vector<std::optional<std::size_t>> found() && { return std::move(found_); }

 private:
  [[nodiscard]] Candidate candidate(std::size_t i, std::size_t j) const {
    const RevisedPart &a = before_[i], &b = after_[j];
    constexpr double kPerNanometre = 1e9, kTurns = 1e9;
    const double turned = (a.drawn->X_WP.R - b.drawn->X_WP.R).squaredNorm();
    return {!isAlike(a, b),
            std::llround(kPerNanometre * distance_m(a, b)),
            std::round(kTurns * turned) / kTurns,
            a.drawn->name != b.drawn->name,
            i,
            j};
  }

  const std::vector<RevisedPart>&before_, &after_;
  std::vector<bool> is_taken_;
  std::vector<std::optional<std::size_t>> found_;
};

bool isAtOnePlace(const RevisedPart& a, const RevisedPart& b) {
  const double within_m = a.error_m + b.error_m + rounding_m(a, b);
  return (a.box_W.min - b.box_W.min).cwiseAbs().maxCoeff() <= within_m &&
         (a.box_W.max - b.box_W.max).cwiseAbs().maxCoeff() <= within_m;
}

}  // namespace

std::vector<std::string> instanceNames(const std::vector<RevisedPart>& parts) {
  std::unordered_map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < parts.size(); ++i) index_of.emplace(parts[i].drawn->name, i);
  std::vector<std::string> names;
  for (const RevisedPart& part : parts) {
    const std::string base = withoutCounter(part.drawn->name);
    const auto first = index_of.find(base);
    const bool is_instance = !base.empty() && first != index_of.end() && isAlike(parts[first->second], part);
    names.push_back(is_instance ? base : part.drawn->name);
  }
  return names;
}

std::vector<std::optional<std::size_t>> matchParts(const std::vector<RevisedPart>& before,
                                                   const std::vector<RevisedPart>& after) {
  const std::vector<std::string> old_names = instanceNames(before), new_names = instanceNames(after);
  Matcher matcher(before, after);
  matcher.match([&](std::size_t i, std::size_t j) { return old_names[i] == new_names[j]; });
  matcher.match([&](std::size_t i, std::size_t j) { return before[i].drawn->name == after[j].drawn->name; });
  matcher.match([&](std::size_t i, std::size_t j) {
    if (!isAlike(before[i], after[j]) || !isAtOnePlace(before[i], after[j])) return false;
    const ShapeChange change = shapeChange(before[i], after[j]);
    const double within_m = before[i].error_m + after[j].error_m + rounding_m(before[i], after[j]);
    return !change.is_reshaped &&
           (change.motion_W * before[i].box_W.center() - before[i].box_W.center()).norm() <= within_m;
  });
  return std::move(matcher).found();
}

}  // namespace vps::scenes
