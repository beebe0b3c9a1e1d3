// SPDX-License-Identifier: BSD-3-Clause
// Reads CAD files that a test has damaged, and compares them with the sound file.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include <Message.hxx>
#include <Message_Messenger.hxx>

#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {

/// The data of a part that are compared. The volume of a round part depends on its triangles and is compared
/// with that of the sound file; the volume of the box is known from its edges.
struct Truth {
  std::string name;
  double volume_m3 = 0;
  Vec3 at_m = Vec3::Zero();
};

class DamagedFile : public testing::Test {
 protected:
  void SetUp() override { Message::DefaultMessenger()->ChangePrinters().Clear(); }

  /// Returns the parts; if the file is refused, the text of the error is in `error`.
  std::optional<ImportedCad> read(const std::string& text, std::string& error,
                                  const char* name = "rig.step") {
    const std::string file = (folder_.path() / name).string();
    std::ofstream(file, std::ios::binary) << text;
    ImportSettings settings;
    settings.deflection_m = 100e-6;
    error.clear();
    try {
      return importCad(file, settings);
    } catch (const LoadError& e) {
      error = e.what();
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
      return std::nullopt;
    }
  }

  static std::vector<Truth> factsOf(const ImportedCad& cad) {
    std::vector<Truth> facts;
    for (const ImportedPart& part : cad.parts)
      facts.push_back({part.name, massProperties(part.mesh).volume_m3, part.X_WP.p});
    return facts;
  }

  /// With same_names false, names may differ, since a name is damaged.
  static void expectSame(const ImportedCad& cad, const std::vector<Truth>& truth, bool same_names,
                         const std::string& what) {
    const std::vector<Truth> found = factsOf(cad);
    ASSERT_EQ(found.size(), truth.size()) << what;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (same_names) {
        EXPECT_EQ(found[i].name, truth[i].name) << what;
      }
      EXPECT_NEAR(found[i].volume_m3, truth[i].volume_m3, 1e-9 * truth[i].volume_m3) << what;
      EXPECT_LT((found[i].at_m - truth[i].at_m).norm(), 1e-9) << what;
    }
  }

  test::TemporaryFolder folder_;
};

}  // namespace vps::scenes
