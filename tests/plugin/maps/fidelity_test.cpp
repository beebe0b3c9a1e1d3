// SPDX-License-Identifier: BSD-3-Clause
#include "vps/fidelity.h"

#include <gtest/gtest.h>

#include <string>

#include "vps/errors.h"

namespace vps {
namespace {

TEST(Fidelity, NormalIsTheDefault) {
  const Fidelity by_name = fidelityPreset("normal"), by_default;
  EXPECT_EQ(by_name.voxel_m, by_default.voxel_m);
  EXPECT_EQ(by_name.spacing_m, by_default.spacing_m);
  EXPECT_EQ(by_name.contact_limit, by_default.contact_limit);
}

TEST(Fidelity, EachPresetIsFinerThanTheOneBefore) {
  const Fidelity fast = fidelityPreset("fast"), normal = fidelityPreset("normal"),
                 fine = fidelityPreset("fine");
  EXPECT_GT(fast.voxel_m, normal.voxel_m);
  EXPECT_GT(normal.voxel_m, fine.voxel_m);
  EXPECT_GT(fast.spacing_m, normal.spacing_m);
  EXPECT_GT(normal.spacing_m, fine.spacing_m);
  EXPECT_LE(fast.contact_limit, normal.contact_limit);
  EXPECT_LE(normal.contact_limit, fine.contact_limit);
}

TEST(Fidelity, AnUnknownNameIsRefusedWithTheKnownNames) {
  try {
    static_cast<void>(fidelityPreset("ultra"));
    FAIL() << "accepted";
  } catch (const LoadError& error) {
    for (const char* word : {"ultra", "fast", "normal", "fine"})
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
  EXPECT_THROW(static_cast<void>(fidelityPreset("")), LoadError);
}

}  // namespace
}  // namespace vps
