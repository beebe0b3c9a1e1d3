// SPDX-License-Identifier: BSD-3-Clause
// The yield of a peg and a hole with normally distributed diameters, which is known by a formula.
#include "vps_scenes/planning/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenes/peg_in_cup.h"
#include "vps/errors.h"

namespace vps::scenes {
namespace {

constexpr double kMean_m = 6e-6;                           // diametral clearance as drawn
constexpr double kBoreSigma_m = 5e-6, kPegSigma_m = 4e-6;  // standard deviations of the diameters

double normalShare(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

/// Share of the pairs in which the bore is larger than the peg.
double formula(double bore_sigma_m, double peg_sigma_m) {
  return normalShare(kMean_m / std::hypot(bore_sigma_m, peg_sigma_m));
}

Scene tolerancedPeg() {
  Scene scene = pegInCup({4e-3 + 0.5 * kMean_m, 4e-3});
  PartTolerance& bore = scene.parts[0].tolerance;
  bore.size_of = SizeOf::Hole;
  bore.lower_m = -3 * kBoreSigma_m;
  bore.upper_m = 3 * kBoreSigma_m;
  PartTolerance& peg = scene.parts[1].tolerance;
  peg.lower_m = -3 * kPegSigma_m;
  peg.upper_m = 3 * kPegSigma_m;
  return scene;
}

/// Runs that are judged by the clearance itself.
StudyResult judgedByClearance(std::size_t count, std::uint64_t seed = 1) {
  const std::vector<StudyVariable> variables = studyVariables(tolerancedPeg());
  std::vector<StudyRun> runs;
  for (std::size_t i = 0; i < count; ++i) {
    StudyRun run{i, Verdict::Fits, {}, {}, 0, sampleStudy(variables, seed, i)};
    if (kMean_m + run.values[0] - run.values[1] < 0) run.verdict = Verdict::Blocked;
    runs.push_back(run);
  }
  return sumUpStudy("peg", variables, {}, runs);
}

std::vector<std::size_t> upTo(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = i;
  return numbers;
}

constexpr StudySettings kGeometry{.seed = 1, .has_contact = false, .threads = 2};

TEST(Study, YieldOfTwoNormalDiametersIsThatOfTheFormulaInNineteenOfTwentyStudies) {
  constexpr std::size_t kStudies = 400, kRuns = 500;
  const double expected = formula(kBoreSigma_m, kPegSigma_m);
  double yield = 0, covered = 0;
  for (std::uint64_t seed = 1; seed <= kStudies; ++seed) {
    const StudyResult result = judgedByClearance(kRuns, seed);
    yield += result.yield / kStudies;
    covered += result.yield_low <= expected && expected <= result.yield_high ? 1 : 0;
    // Half width of a 95 % interval, up to Wilson's corrections of the order 1 / runs.
    const double half = 1.96 * std::sqrt(result.yield * (1 - result.yield) / kRuns);
    EXPECT_NEAR(0.5 * (result.yield_high - result.yield_low), half, 0.02 * half);
  }
  // Four standard deviations of a mean, and of the number of 95 % intervals that contain the true value.
  EXPECT_NEAR(yield, expected, 4 * std::sqrt(expected * (1 - expected) / (kStudies * kRuns)));
  EXPECT_NEAR(covered, 0.95 * kStudies, 4 * std::sqrt(0.95 * 0.05 * kStudies));
}

TEST(Study, HalvingATolerancesGivesTheYieldOfTheFormulaForIt) {
  const StudyResult result = judgedByClearance(20000);
  ASSERT_EQ(result.effects.size(), 2U);
  EXPECT_EQ(result.effects[0].variable.name, "cup size");  // the wider tolerance has the greater effect
  for (const StudyEffect& effect : result.effects) {
    const bool is_bore = effect.variable.name == "cup size";
    const double expected =
        formula(is_bore ? 0.5 * kBoreSigma_m : kBoreSigma_m, is_bore ? kPegSigma_m : 0.5 * kPegSigma_m);
    EXPECT_NEAR(effect.gain, expected - formula(kBoreSigma_m, kPegSigma_m), 1.5 * effect.gain_error)
        << effect.variable.name;
    EXPECT_LT(effect.gain_error, 0.01);
  }
}

TEST(Study, OfMeshesWhoseFacesAreOffsetHasTheYieldOfTheFormula) {
  const Scene scene = tolerancedPeg();
  const std::vector<StudyVariable> variables = studyVariables(scene);
  const StudyResult result =
      sumUpStudy("peg", variables, kGeometry, runStudy(scene, variables, kGeometry, upTo(100)));
  const double expected = formula(kBoreSigma_m, kPegSigma_m);
  EXPECT_LE(result.yield_low, expected);
  EXPECT_GE(result.yield_high, expected);
  // The verdict of each run has to follow from its two deviations. The meshes' coordinates are exact to
  // nanometres.
  for (const StudyRun& run : result.runs) {
    const double clearance_m = kMean_m + run.values[0] - run.values[1];
    if (std::abs(clearance_m) > 0.05e-6) {
      EXPECT_EQ(run.verdict == Verdict::Fits, clearance_m > 0) << run.run << ": " << clearance_m;
    }
  }
}

TEST(Study, ARunHasTheSameBitsAloneAndAmongOthers) {
  const Scene scene = tolerancedPeg();
  const std::vector<StudyVariable> variables = studyVariables(scene);
  StudySettings one = kGeometry;
  one.threads = 1;
  const std::vector<StudyRun> all = runStudy(scene, variables, kGeometry, upTo(6));
  const std::vector<StudyRun> alone = runStudy(scene, variables, one, {4});
  ASSERT_EQ(all.size(), 6U);
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone[0].values, all[4].values);
  EXPECT_EQ(alone[0].verdict, all[4].verdict);
  EXPECT_EQ(alone[0].reason, all[4].reason);
  EXPECT_NE(all[4].values, all[3].values);
}

TEST(Study, ARunByContactIsRepeatedToTheBit) {
  Scene scene = pegInCup({});
  scene.parts[1].tolerance.lower_m = -10e-6;
  scene.parts[1].tolerance.upper_m = 10e-6;
  const std::vector<StudyVariable> variables = studyVariables(scene);
  const StudySettings settings{.seed = 3, .has_contact = true, .threads = 2};
  const std::vector<StudyRun> two = runStudy(scene, variables, settings, {0, 7});
  const std::vector<StudyRun> again = runStudy(scene, variables, settings, {7});
  ASSERT_EQ(two.size(), 2U);
  EXPECT_GT(two[1].simulated_s, 0);
  EXPECT_EQ(again[0].simulated_s, two[1].simulated_s);
  EXPECT_EQ(again[0].verdict, two[1].verdict);
  EXPECT_EQ(two[1].verdict, Verdict::Fits) << two[1].reason;
}

TEST(Study, AnotherSeedOrAnotherToleranceIsAnotherStudy) {
  Scene scene = tolerancedPeg();
  std::set<std::string> prints;
  const auto add = [&](const StudySettings& settings) {
    prints.insert(studyFingerprint(scene, studyVariables(scene), settings));
  };
  add(kGeometry);
  add({.seed = 1, .has_contact = false, .threads = 7});  // the number of threads does not change the study
  EXPECT_EQ(prints.size(), 1U);
  add({.seed = 2, .has_contact = false});
  add({.seed = 1, .has_contact = true});
  scene.parts[1].tolerance.upper_m *= 1.5;
  add(kGeometry);
  scene.parts[1].tolerance.distribution = Distribution::Uniform;
  add(kGeometry);
  EXPECT_EQ(prints.size(), 5U);
}

// Logs of earlier versions stay valid only if the draws never change.
TEST(Study, TheDrawsOfASeedRunAndNameAreThoseOfEarlierVersions) {
  StudyVariable uniform, normal;
  uniform.name = "a";
  uniform.distribution = Distribution::Uniform;
  normal.name = "b";
  for (StudyVariable* variable : {&uniform, &normal}) {
    variable->lower = -1;
    variable->upper = 1;
  }
  const std::vector<double> values = sampleStudy({uniform, normal}, 7, 3);
  EXPECT_EQ(values[0], 0.21670628020008209);
  EXPECT_NEAR(values[1], -0.22037245646406919, 1e-15);  // rounding of the standard library's log and cos
}

TEST(Study, UniformDeviationsLieEvenlyWithinTheirLimits) {
  StudyVariable variable;
  variable.name = "x";
  variable.distribution = Distribution::Uniform;
  variable.lower = -1;
  variable.upper = 3;
  double sum = 0, squares = 0;
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    const double x = sampleStudy({variable}, 5, static_cast<std::size_t>(i))[0];
    EXPECT_GT(x, -1);
    EXPECT_LT(x, 3);
    sum += x;
    squares += (x - 1) * (x - 1);
  }
  // Variance 16/12; the bounds are four standard errors of mean and variance.
  EXPECT_NEAR(sum / kCount, 1, 4 * std::sqrt(16.0 / 12 / kCount));
  EXPECT_NEAR(squares / kCount, 16.0 / 12, 4 * std::sqrt((16.0 / 5 - 16.0 / 9) / kCount));
}

// By ISO 286, H7 of 8 mm is 0 to +15 um, and g6 is -14 to -5 um.
TEST(Study, AToleranceClassIsRelativeToTheNominalSize) {
  Scene scene = pegInCup({4.01e-3, 4e-3});
  scene.parts[0].tolerance.size_class = "H7";
  scene.parts[1].tolerance.size_class = "g6";
  const std::vector<StudyVariable> variables = studyVariables(scene);
  ASSERT_EQ(variables.size(), 2U);
  EXPECT_TRUE(variables[0].is_hole);
  EXPECT_FALSE(variables[1].is_hole);
  EXPECT_NEAR(variables[0].lower, -20e-6, 1e-8);  // the drawn size is 20 um above 8 mm
  EXPECT_NEAR(variables[0].upper, -5e-6, 1e-8);
  EXPECT_NEAR(variables[1].lower, -14e-6, 1e-8);
  EXPECT_NEAR(variables[1].upper, -5e-6, 1e-8);
}

// A hole off its drawn position reduces the room of the peg on one side. An offset beyond the gap makes the
// peg overlap as drawn, but the peg follows the hole within its tolerance, so that nothing is blocked.
TEST(Study, AnOffsetPlaceThatThePegCanFollowDoesNotBlockIt) {
  Scene scene = pegInCup({4.01e-3, 4e-3});
  scene.parts[0].tolerance.position_m = 20e-6;
  scene.parts[0].tolerance.distribution = Distribution::Uniform;
  const std::vector<StudyVariable> variables = studyVariables(scene);
  ASSERT_EQ(variables.size(), 3U);
  const std::vector<StudyRun> runs = runStudy(scene, variables, kGeometry, upTo(24));
  std::size_t beyond = 0;
  for (const StudyRun& run : runs) {
    const double off_m = std::hypot(run.values[0], run.values[1]);
    beyond += off_m > 10e-6 ? 1 : 0;
    EXPECT_NE(run.verdict, Verdict::Blocked) << run.run << ": " << off_m << " " << run.reason;
    if (off_m < 9.9e-6) {
      EXPECT_EQ(run.verdict, Verdict::Fits) << run.run << ": " << run.reason;
    }
  }
  EXPECT_GT(beyond, 0U);
}

TEST(Study, WithoutAToleranceOrWithOneThatIsNotKnownIsRefused) {
  Scene scene = pegInCup({4.01e-3, 4e-3});
  EXPECT_THROW(studyVariables(scene), LoadError);
  scene.parts[1].tolerance.size_class = "q9";
  EXPECT_THROW(studyVariables(scene), LoadError);
  scene.parts[1].tolerance.size_class = "H7";  // a class for holes, but the peg is a shaft
  EXPECT_THROW(studyVariables(scene), LoadError);
  scene.parts[1].tolerance = {};
  scene.parts[1].tolerance.lower_m = 1e-6;
  EXPECT_THROW(studyVariables(scene), LoadError);
}

TEST(Study, ARunThatIsThereTwiceCountsOnce) {
  const std::vector<StudyVariable> variables = studyVariables(tolerancedPeg());
  const auto run = [&](std::size_t number, Verdict verdict) {
    return StudyRun{number, verdict, {}, {}, 0, sampleStudy(variables, 1, number)};
  };
  const StudyResult result = sumUpStudy(
      "peg", variables, {}, {run(1, Verdict::Fits), run(0, Verdict::Blocked), run(1, Verdict::Fits)});
  EXPECT_EQ(result.runs.size(), 2U);
  EXPECT_EQ(result.good, 1U);
  EXPECT_EQ(result.yield, 0.5);
}

}  // namespace
}  // namespace vps::scenes
