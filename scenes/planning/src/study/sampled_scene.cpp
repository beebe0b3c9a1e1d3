// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include "study/variants.h"
#include "vps_device/random.h"
#include "vps_scenes/planning/study.h"

namespace vps::scenes {

namespace {

constexpr double kSigmas = 3;  // standard deviations from the middle to a limit: 99.73 % of a normal
                               // distribution lie within three of them

std::uint64_t mixed(std::uint64_t x) {
  return device::Random(x).next();
}

/// FNV-1a hash.
std::uint64_t hashOf(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return hash;
}

/// Generator for one run of a study and one name. The random numbers do not depend on other runs and names.
device::Random generatorOf(std::uint64_t seed, std::uint64_t run, std::string_view name) {
  return device::Random(mixed(mixed(mixed(seed) ^ run) ^ hashOf(name)));
}

/// Uniform in the open interval (0, 1); Random::uniform() includes 0, whose logarithm is not finite.
double openUniform(device::Random& random) {
  return (static_cast<double>(random.next() >> 11) + 0.5) * 0x1p-53;
}

/// Standard normal. Source: [Box and Muller 1958].
double standardNormal(device::Random& random) {
  const double radius = std::sqrt(-2 * std::log(openUniform(random)));
  return radius * std::cos(2 * std::numbers::pi * openUniform(random));
}

void add(const StudyVariable& variable, double value, PartDeviation& to) {
  switch (variable.quantity) {
    case StudyQuantity::Size:
      to.growth_m += (variable.is_hole ? -0.5 : 0.5) * value;  // half of the deviation on each side
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
    device::Random random = generatorOf(seed, run, variable.name);
    const double half = 0.5 * (variable.upper - variable.lower);
    const double of_half = variable.distribution == Distribution::Normal ? standardNormal(random) / kSigmas
                                                                         : 2 * openUniform(random) - 1;
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
  sampled.hand.seed = generatorOf(seed, run, "hand").next() >> 32;
  return sampled;
}

}  // namespace vps::scenes
