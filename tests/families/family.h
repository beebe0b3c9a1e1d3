// SPDX-License-Identifier: BSD-3-Clause
// A family: generated members of one kind of situation, whose right answer is known by construction.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace vps::families {

/// One measured quantity of a kind, over all members of the family.
struct Family {
  std::string key;      ///< letter of the kind and a short name: "B_cubes"
  std::string measure;  ///< what is measured, with its unit: "greatest energy over that at the start"
  double bar = 0;       ///< the family holds if no member's value is above this bar
  int members = 0;      ///< number of members; member i is the same in every run
  int every = 1;        ///< the short form runs members 0, every, 2 every, ...
  /// Measures one member; must not depend on other members. NaN counts as above the bar.
  std::function<double(int member)> measured;
  /// Parameters of one member in words, for the table's worst member.
  std::function<std::string(int member)> describe = nullptr;
  /// A family that does not hold today: its greatest value today, over all members. The run fails if a value
  /// is above this expected value, and also if all values are below the bar, until the expectation is removed
  /// here.
  std::optional<double> expected_failure = std::nullopt;
  /// The expected value of the short form, if it does not include the worst member; 0: the short form holds.
  std::optional<double> expected_failure_short = std::nullopt;
};

/// The families of each kind, in the order of the table in README.md.
std::vector<Family> materialFamilies();      // A: each fixed part has its own material
std::vector<Family> restitutionFamilies();   // B: restitution never makes energy
std::vector<Family> narrowGapFamilies();     // C: restitution in gaps below a step's travel
std::vector<Family> nutGapFamilies();        // C: restitution of nuts on their rods
std::vector<Family> rotationFamilies();      // D: free rotation, fast rotation
std::vector<Family> shellFamilies();         // E: several shells in one mesh; mass of a repaired mesh
std::vector<Family> resolutionFamilies();    // F: resolution by the part's and its neighbours' size
std::vector<Family> roundBodyFamilies();     // G: finely meshed round bodies
std::vector<Family> rollingFamilies();       // H: rolling without brake or drive
std::vector<Family> flushStartFamilies();    // I: a start exactly flush
std::vector<Family> openSurfaceFamilies();   // J: open surfaces have no lids
std::vector<Family> spinningFaceFamilies();  // K: friction of a spinning face
std::vector<Family> penaltyFallFamilies();   // L: penalty contact of bodies that fall together
std::vector<Family> loadedThreadFamilies();  // M: a loaded thread
std::vector<Family> mechanismFamilies();     // N: mechanisms do not halt

// Families of the kinds above that have sources of their own.
std::vector<Family> bounceFamilies();        // B: bounces under gravity
std::vector<Family> massRatioFamilies();     // B: rows with a body of another mass
std::vector<Family> fastRotationFamilies();  // D: fast rotation
std::vector<Family> flatSpinFamilies();      // D: bodies that spin flat on a plate

std::vector<Family> judgeFamilies();  // C, G: the judge sees passages, and its depth is exact

std::vector<Family> allFamilies();

/// The result of a family.
struct Outcome {
  double worst = -std::numeric_limits<double>::infinity();  ///< greatest value
  int worst_member = -1;
  int run = 0;                     ///< members measured
  int above = 0;                   ///< members above the bar
  std::vector<int> members_above;  ///< numbers of these members, ascending
  double cpu_s = 0;
};

enum class Verdict { Holds, ExpectedFailure, Fails, Worse, HoldsUnexpectedly };
const char* nameOf(Verdict verdict);

/// @param member  only this member; -1: all members, or the members of the short form
Outcome measure(const Family& family, bool is_short, int member = -1);
Verdict judge(const Family& family, const Outcome& outcome, bool is_short);

}  // namespace vps::families
