// SPDX-License-Identifier: BSD-3-Clause
#include "order/proven_enclosed.h"

#include <algorithm>
#include <cstddef>

#include "overlaps/drawn_overlaps.h"
#include "proof/enclosure.h"

namespace vps::scenes {

namespace {

// Limits of the work, in the unit of Enclosure::work, of which two or three million take a second.
constexpr std::size_t kMostWorkOfPair = 10'000'000, kMostWork = 12'000'000;

struct Question {
  BlockedPart* part;
  const PlacedSurface *surface, *by;
  Enclosure answer;
};

/// Rings, clips and springs bend, so that nothing about them as rigid bodies answers whether they come off.
bool isRigid(const PlacedSurface& part) {
  return !isWireLike(part.surface->mesh());
}

}  // namespace

void proveEnclosed(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                   std::vector<PlannedAssembly>& assemblies, const Progress& progress) {
  const auto isKnown = [&](const std::string& a, const std::string& b) {
    return std::ranges::any_of(checked.pairs, [&](const CheckedPair& pair) {
      return pair.isKnown() && ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a));
    });
  };
  std::vector<Question> questions;
  for (PlannedAssembly& assembly : assemblies)
    for (BlockedPart& part : assembly.blocked)
      for (const std::string& by : part.by) {
        const PlacedSurface &of = named(parts, part.name), &other = named(parts, by);
        if (!isKnown(part.name, by) && isRigid(of) && isRigid(other))
          questions.push_back({&part, &of, &other, {}});
      }
  if (questions.empty()) return;
  // Each question has its share of the work beforehand, so that the answers do not depend on the order.
  const std::size_t each = std::min(kMostWorkOfPair, kMostWork / questions.size());
  forEachOnCores(questions.size(), progress, "proving that parts cannot be taken off", [&](std::size_t i) {
    questions[i].answer = enclosureOfPair(*questions[i].surface, *questions[i].by, each);
  });
  for (const Question& question : questions) {
    if (!question.answer.is_proven || !question.part->enclosed_by.empty()) continue;
    const SixNumbers most = question.answer.high.cwiseMax(-question.answer.low);
    question.part->enclosed_by = question.by->name;
    question.part->moves_m = most.head<3>().norm();
    question.part->turns_rad = most.tail<3>().maxCoeff();
  }
}

}  // namespace vps::scenes
