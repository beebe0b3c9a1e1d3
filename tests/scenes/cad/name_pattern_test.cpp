// SPDX-License-Identifier: BSD-3-Clause
// Patterns of part names.
#include <gtest/gtest.h>

#include <string>

#include "import/part_names.h"

namespace vps::scenes::import {
namespace {

TEST(NamePattern, AStarStandsForAnyText) {
  for (const char* pattern : {"shaft_2", "*", "shaft*", "*_2", "s*f*2", "**shaft_2", "shaft_2*", "*a*t*"})
    EXPECT_TRUE(matchesPattern("shaft_2", pattern)) << pattern;
  for (const char* pattern : {"", "shaft", "haft*", "*_", "s*x*2", "shaft_22", "Shaft_2", "shaft_2*2"})
    EXPECT_FALSE(matchesPattern("shaft_2", pattern)) << pattern;
  EXPECT_TRUE(matchesPattern("", ""));
  EXPECT_TRUE(matchesPattern("", "*"));
  EXPECT_TRUE(matchesPattern("aab", "*ab"));  // the first a belongs to the star
}

// A search that tries all texts for each star would take hours.
TEST(NamePattern, ManyStarsTakeNoTime) {
  std::string pattern;
  for (int i = 0; i < 40; ++i) pattern += "a*";
  EXPECT_FALSE(matchesPattern(std::string(200, 'a'), pattern + "b"));
}

}  // namespace
}  // namespace vps::scenes::import
