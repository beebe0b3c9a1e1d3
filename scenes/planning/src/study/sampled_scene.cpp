// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "study/counted_draw.h"
#include "study/varied_scene.h"
#include "vps_scenes/planning/study.h"

namespace vps::scenes {

namespace {

constexpr double kSigmas =
    3;  // from the middle to a limit: 99.73 % of a normal distribution lie within three

void add(const StudyVariable& variable, double value, PartDeviation& to) {
  switch (variable.quantity) {
    case StudyQuantity::Size:
      to.growth_m += (variable.is_hole ? -0.5 : 0.5) * value;  // half on each side
      break;
    case StudyQuantity::X:
    case StudyQuantity::Y:
    case StudyQuantity::Z:
      to.move_P_m[static_cast<int>(variable.quantity) - static_cast<int>(StudyQuantity::X)] += value;
      break;
    case StudyQuantity::AboutX:
    case StudyQuantity::AboutY:
    case StudyQuantity::AboutZ:
      to.turn_P_rad[static_cast<int>(variable.quantity) - static_cast<int>(StudyQuantity::AboutX)] += value;
      break;
    case StudyQuantity::Friction:
      to.friction += value;
      break;
  }
}

}  // namespace

std::vector<double> sampleStudy(const std::vector<StudyVariable>& variables, std::uint64_t seed,
                                std::size_t run) {
  std::vector<double> values;
  for (const StudyVariable& variable : variables) {
    const CountedDraw draw(seed, run, variable.name);
    const double half = 0.5 * (variable.upper - variable.lower);
    const double of_half =
        variable.distribution == Distribution::Normal ? draw.normal() / kSigmas : 2 * draw.uniform() - 1;
    values.push_back(variable.middle() + half * of_half);
  }
  return values;
}

Scene sampledScene(const Scene& scene, const std::vector<StudyVariable>& variables, std::uint64_t seed,
                   std::size_t run) {
  std::vector<PartDeviation> deviations(scene.parts.size());
  const std::vector<double> values = sampleStudy(variables, seed, run);
  for (std::size_t i = 0; i < variables.size(); ++i)
    add(variables[i], values[i], deviations[variables[i].part]);
  Scene sampled = withDeviations(scene, deviations);
  // Scene files and recordings store seeds as signed numbers, so the seed has 32 bits.
  sampled.hand.seed = CountedDraw(seed, run, "hand").bits(0) >> 32;
  return sampled;
}

}  // namespace vps::scenes
