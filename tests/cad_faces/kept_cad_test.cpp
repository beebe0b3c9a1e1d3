// SPDX-License-Identifier: BSD-3-Clause
// CAD files that were read before come from the cache, to the bit, unless anything about them has changed.
#include "import/part_bytes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <BRepPrimAPI_MakeCylinder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>

#include "support/temporary_folder.h"
#include "vps/byte_cache.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {
namespace {

namespace fs = std::filesystem;

class KeptCad : public testing::Test {
 protected:
  void SetUp() override {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    writeCylinder(5);
    settings_.cache = &cache_;
  }
  void writeCylinder(double radius_mm) const {
    STEPControl_Writer writer;
    writer.Transfer(BRepPrimAPI_MakeCylinder(radius_mm, 20).Shape(), STEPControl_AsIs);
    EXPECT_EQ(writer.Write(step().c_str()), IFSelect_RetDone);
  }
  [[nodiscard]] std::string step() const { return (folder_.path() / "shaft.step").string(); }
  [[nodiscard]] std::string madeFrom() const {
    return import::madeFrom(step(), import::CadFormat::Step, settings_);
  }
  [[nodiscard]] std::size_t files() const {
    const fs::path folder = folder_.path() / "cache";
    if (!fs::exists(folder)) return 0;
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
  ByteCache cache_{folder_.path() / "cache", [this](const std::string& line) { warnings_.push_back(line); }};
  ImportSettings settings_;
};

TEST_F(KeptCad, ComesBackToTheBit) {
  const ImportedCad first = importCad(step(), settings_), second = importCad(step(), settings_);
  EXPECT_EQ(files(), 1U);
  ASSERT_EQ(second.parts.size(), 1U);
  EXPECT_EQ(second.file, first.file);
  EXPECT_EQ(second.format, "STEP");
  EXPECT_TRUE(first.states_unit && second.states_unit);
  EXPECT_EQ(second.warnings, first.warnings);
  EXPECT_EQ(import::keptBytes(second), import::keptBytes(first));  // all data that transfer() returns
  EXPECT_EQ(second.parts[0].mesh.vertices, first.parts[0].mesh.vertices);
  EXPECT_EQ(second.parts[0].mesh.triangles, first.parts[0].mesh.triangles);
  EXPECT_EQ(second.parts[0].deflection_m, first.parts[0].deflection_m);
}

TEST_F(KeptCad, IsWhatIsThenShownInPlaceOfReadingTheFile) {
  ImportedCad other = importCad(step(), settings_);
  other.parts[0].name = "kept";
  cache_.keep(madeFrom(), import::keptBytes(other));
  EXPECT_EQ(importCad(step(), settings_).parts[0].name, "kept");
  const std::string scene = (folder_.path() / "scene.toml").string();
  std::ofstream(scene) << "cad = 'shaft.step'\n[[part]]\nname = 'kept'\nfixed = true\n";
  EXPECT_EQ(loadScene(scene, {}, &cache_).parts[0].part.name, "kept");
  settings_.cache = nullptr;
  EXPECT_NE(importCad(step(), settings_).parts[0].name, "kept");
}

TEST_F(KeptCad, OfAnotherContentNameOrSettingIsAnother) {
  const ImportedCad thin = importCad(step(), settings_);
  writeCylinder(6);
  const ImportedCad thick = importCad(step(), settings_);
  EXPECT_GT(bounds(thick.parts[0].mesh).size().x(), bounds(thin.parts[0].mesh).size().x());
  settings_.deflection_m = 1e-4;
  EXPECT_LT(importCad(step(), settings_).parts[0].mesh.triangles.size(),
            thick.parts[0].mesh.triangles.size());
  const fs::path renamed = folder_.path() / "bolt.step";
  fs::rename(step(), renamed);
  static_cast<void>(importCad(renamed.string(), settings_));
  EXPECT_EQ(files(), 4U);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(KeptCad, ThatIsDamagedOrForeignIsReadAgainAndReplaced) {
  const ImportedCad first = importCad(step(), settings_);
  const fs::path file = cache_.fileOf(madeFrom());
  std::ofstream(file, std::ios::binary) << "something else";
  EXPECT_EQ(import::keptBytes(importCad(step(), settings_)), import::keptBytes(first));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("computed again"), std::string::npos) << warnings_[0];
  // The entry is complete, but does not contain parts.
  cache_.keep(madeFrom(), "something else");
  EXPECT_EQ(import::keptBytes(importCad(step(), settings_)), import::keptBytes(first));
  EXPECT_EQ(cache_.find(madeFrom()), import::keptBytes(first));
  EXPECT_EQ(warnings_.size(), 1U);
}

TEST_F(KeptCad, CutAnywhereIsNotTaken) {
  const std::string bytes = import::keptBytes(importCad(step(), settings_));
  for (std::size_t size = 0; size < bytes.size(); size += size < 400 ? 1 : 997) {
    ImportedCad cad;
    EXPECT_FALSE(import::readKeptBytes(bytes.substr(0, size), cad)) << size;
    EXPECT_TRUE(cad.parts.empty());
  }
}

TEST_F(KeptCad, WithATriangleWhoseCornerOrColorDoesNotExistIsNotTaken) {
  const ImportedCad good = importCad(step(), settings_);
  const auto isTaken = [](const ImportedCad& kept) {
    ImportedCad cad;
    return import::readKeptBytes(import::keptBytes(kept), cad);
  };
  EXPECT_TRUE(isTaken(good));
  ImportedCad bad = good;
  bad.parts[0].mesh.triangles.back()[1] = std::uint32_t(bad.parts[0].mesh.vertices.size());
  EXPECT_FALSE(isTaken(bad));
  bad = good;
  FaceColors& colors = bad.parts[0].face_colors;
  colors.palette = {{0.5f, 0.5f, 0.5f}};
  colors.of_triangle.assign(bad.parts[0].mesh.triangles.size(), 0);
  EXPECT_TRUE(isTaken(bad));
  colors.of_triangle.back() = 1;
  EXPECT_FALSE(isTaken(bad));
  colors.of_triangle.assign(1, 0);
  EXPECT_FALSE(isTaken(bad));
}

TEST_F(KeptCad, WithABoolThatIsNeitherIsNotTaken) {
  const ImportedCad cad = importCad(step(), settings_);
  ImportedCad without = cad;
  without.parts[0].deflection_m.reset();
  std::string bytes = import::keptBytes(cad);
  const std::string other = import::keptBytes(without);
  const auto flag = std::ranges::mismatch(bytes, other).in1;  // the first byte that differs
  ASSERT_EQ(*flag, 1);
  *flag = 2;
  ImportedCad found;
  EXPECT_FALSE(import::readKeptBytes(bytes, found));
}

TEST_F(KeptCad, OfAFileThatNamesOthersIsNotKept) {
  std::ofstream(step(), std::ios::app) << "/* DOCUMENT_FILE */\n";
  EXPECT_EQ(madeFrom(), "");
  static_cast<void>(importCad(step(), settings_));
  EXPECT_EQ(files(), 0U);
  EXPECT_EQ(import::madeFrom(step(), import::CadFormat::Gltf, settings_), "");
  EXPECT_EQ(import::madeFrom("nowhere.step", import::CadFormat::Step, settings_), "");
}

}  // namespace
}  // namespace vps::scenes
