// SPDX-License-Identifier: BSD-3-Clause
// CAD files that are valid but unusual, made by tests from two known solids, and what the importer must make
// of them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes::odd {

inline const Color kRed{1, 0, 0}, kGreen{0, 1, 0}, kBlue{0, 0, 1};

/// What the importer must find of a part, in the frame of the assembly.
struct OddPart {
  std::string name;
  Vec3 min_m, max_m;
  double volume_m3 = 0;
  std::optional<Color> color = {};  ///< linear; empty: any
};

/// A block of 10 x 20 x 30 at the origin, and a plate in the shape of an L at (100, 0, 0): 30 x 30 x 10
/// without a corner of 20 x 20 x 10. In units of the file.
inline OddPart oddBlock(double unit_m, const std::string& name = "block", std::optional<Color> color = {}) {
  return {name, Vec3::Zero(), unit_m * Vec3(10, 20, 30), 6000 * unit_m * unit_m * unit_m, color};
}
inline OddPart oddEll(double unit_m, const std::string& name = "ell", std::optional<Color> color = {}) {
  return {name, unit_m * Vec3(100, 0, 0), unit_m * Vec3(130, 30, 10), 5000 * unit_m * unit_m * unit_m, color};
}

/// The block as a mesh, in units of the file.
inline Mesh oddBlockMesh() {
  Mesh mesh = makeBox(Vec3(10, 20, 30));
  for (Vec3& p : mesh.vertices) p += Vec3(5, 10, 15);
  return mesh;
}
/// The L as a mesh with its corner at x; vertices 0 to 5 are below, 6 to 11 above.
inline Mesh oddEllMesh(double x = 0) {
  Mesh mesh;
  const double corners[6][2] = {{0, 0}, {30, 0}, {30, 10}, {10, 10}, {10, 30}, {0, 30}};
  for (const double z : {0.0, 10.0})
    for (const auto& corner : corners) mesh.vertices.emplace_back(corner[0] + x, corner[1], z);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    mesh.triangles.push_back({i, next, next + 6});
    mesh.triangles.push_back({i, next + 6, i + 6});
  }
  for (const auto& [a, b] : {std::pair(4U, 5U), std::pair(5U, 0U), std::pair(0U, 1U), std::pair(1U, 2U)}) {
    mesh.triangles.push_back({9, a + 6, b + 6});
    mesh.triangles.push_back({3, b, a});
  }
  return mesh;
}

inline std::string replacedAll(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}
/// The text with its first `from` replaced, which must be there.
inline std::string replacedOnce(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

struct OddFile {
  std::string oddity;
  std::string bytes;
  std::vector<OddPart> parts;
  std::string lost = {};              ///< words of the refusal; empty: the file is read
  bool has_remark = false;            ///< a warning is expected; without, none is allowed
  std::string name = {};              ///< of the file; empty: that of the format
  std::optional<double> unit_m = {};  ///< of the settings
  std::vector<std::pair<std::string, std::string>> beside =
      {};  ///< names and bytes of files that this file names
};

class OddFiles : public testing::Test {
 protected:
  /// Reads the file as `vps import` does, and compares.
  void expectRead(const OddFile& odd, const std::string& usual_name) {
    SCOPED_TRACE(usual_name + ": " + odd.oddity);
    ++count_;
    for (const auto& [name, bytes] : odd.beside) vps::test::write(folder_.path() / name, bytes);
    const std::string file = (folder_.path() / (odd.name.empty() ? usual_name : odd.name)).string();
    vps::test::write(file, odd.bytes);
    ImportSettings settings;
    settings.unit_m = odd.unit_m;
    try {
      compare(importCad(file, settings), odd);
    } catch (const LoadError& e) {
      const std::string error = e.what();
      if (odd.lost.empty())
        ADD_FAILURE() << "is refused: " << error;
      else
        EXPECT_NE(error.find(odd.lost), std::string::npos) << error;
    }
    std::filesystem::remove(file);
  }
  void expectAll(const std::vector<OddFile>& all, const std::string& usual_name) {
    for (const OddFile& odd : all) expectRead(odd, usual_name);
    RecordProperty("files", count_);
  }

  vps::test::TemporaryFolder folder_;

 private:
  static void compare(const ImportedCad& cad, const OddFile& odd) {
    if (!odd.lost.empty()) {
      ADD_FAILURE() << "is read without what it lost";
      return;
    }
    std::string warnings;
    for (const std::string& warning : cad.warnings)
      if (warning.find("check the unit") == std::string::npos &&
          warning.find("from the origin") == std::string::npos)
        warnings += warning + "\n";
    EXPECT_EQ(!warnings.empty(), odd.has_remark) << warnings;
    std::string names;
    for (const ImportedPart& part : cad.parts) names += "'" + part.name + "' ";
    ASSERT_EQ(cad.parts.size(), odd.parts.size()) << names;
    for (std::size_t i = 0; i < cad.parts.size(); ++i) expectPart(cad.parts[i], odd.parts[i]);
  }
  static void expectPart(const ImportedPart& found, const OddPart& truth) {
    EXPECT_EQ(found.name, truth.name);
    const Mesh mesh = transformed(found.mesh, found.X_WP);
    const double size_m = (truth.max_m - truth.min_m).norm() + truth.max_m.norm();
    // Formats of meshes round to 24 bits.
    EXPECT_LT((bounds(mesh).min - truth.min_m).norm(), 1e-6 * size_m)
        << truth.name << " begins at " << bounds(mesh).min.transpose();
    EXPECT_LT((bounds(mesh).max - truth.max_m).norm(), 1e-6 * size_m)
        << truth.name << " ends at " << bounds(mesh).max.transpose();
    EXPECT_NEAR(massProperties(mesh).volume_m3, truth.volume_m3, 1e-5 * truth.volume_m3) << truth.name;
    EXPECT_TRUE(checkMesh(found.mesh).isClosed()) << truth.name;
    for (std::size_t k = 0; truth.color && k < 3; ++k)
      EXPECT_NEAR(found.color[k], (*truth.color)[k], 2e-3) << truth.name << ", colour " << k;
  }
  int count_ = 0;
};

}  // namespace vps::scenes::odd
