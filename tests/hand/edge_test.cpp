// SPDX-License-Identifier: BSD-3-Clause
// Verdicts on both sides of the edge between fit and misfit; README.md has the whole table.
#include <gtest/gtest.h>

#include "edge_case.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

scenes::StepResult stepOf(const EdgeCase& edge) {
  scenes::Scene scene = edgeScene(edge);
  scenes::AssembleOptions options;
  options.judge_stride = 1000;
  return scenes::assemble(scene, options).steps.at(0);
}

std::vector<EdgeCase> row(const std::string& name) {
  std::vector<EdgeCase> cases;
  for (const EdgeCase& edge : edgeCases(1))
    if (rowName(edge) == name) cases.push_back(edge);
  return cases;
}

void expectRight(const std::string& name, std::initializer_list<int> clearances_um) {
  for (const EdgeCase& edge : row(name))
    for (const int clearance_um : clearances_um)
      if (std::abs(edge.fit.clearance_m - 1e-6 * clearance_um) < 1e-9) {
        const scenes::StepResult step = stepOf(edge);
        EXPECT_EQ(outcomeOf(edge, step.verdict), EdgeOutcome::Right)
            << caseName(edge) << ": " << toText(step.verdict) << ", " << step.reason;
      }
}

TEST(Edge, ARoundPegIsBlockedFiveMicrometresBelowZeroAndFitsAbove) {
  expectRight("round 4 mm chamfered closed", {-50, -5, 10, 50});
  expectRight("round 8 mm chamfered faulty", {-10, 20});
}

TEST(Edge, ARectangularPegIsBlockedFiveMicrometresBelowZeroAndFitsAbove) {
  expectRight("rectangular 8 mm chamfered closed", {-50, -5, 50});
  expectRight("rectangular 4 mm chamfered faulty", {-10, 30});
}

// The mesh of the hole has cracks of up to 0.5 um, which were once taken for edges of the part. The peg with
// 40 um settles by 9 um within its clearance when it is released, and is at rest then.
TEST(Edge, ASharpPegFitsAMeshWithCracksAndMaySettleInItsHole) {
  expectRight("round 4 mm sharp faulty", {30, 40});
  // A crack once moved a corner of the peg by 0.3 um into the bottom of the hole, which is no clash.
  expectRight("rectangular 8 mm sharp faulty", {10});
}

TEST(Edge, VerdictsFartherFromZeroThanTheBandAreCountedAsWrong) {
  EdgeCase edge = row("round 16 mm sharp closed").front();
  edge.fit.clearance_m = 1.01 * edgeBand_m(edge);
  EXPECT_EQ(outcomeOf(edge, scenes::Verdict::Blocked), EdgeOutcome::Wrong);
  EXPECT_EQ(outcomeOf(edge, scenes::Verdict::NotShown), EdgeOutcome::MissedFit);
  edge.fit.clearance_m *= -1;
  EXPECT_EQ(outcomeOf(edge, scenes::Verdict::Fits), EdgeOutcome::Wrong);
  EXPECT_EQ(outcomeOf(edge, scenes::Verdict::NotShown), EdgeOutcome::Wrong);
}

}  // namespace
}  // namespace vps::hand
