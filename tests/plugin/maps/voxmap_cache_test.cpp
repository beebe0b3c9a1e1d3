// SPDX-License-Identifier: BSD-3-Clause
// The cache gives the same maps as building, to the bit, whatever damage its files have.
#include "vps/voxmap_cache.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include "support/analytic.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps/mesh_repair.h"
#include "vps/solid.h"

namespace vps::test {
namespace {

namespace fs = std::filesystem;

constexpr VoxMapSettings kCachedSettings = {0.5e-3, 4};

Mesh part() {
  return transformed(makeTube(0.01, 0.006, 0.012, 48), RandomPoints(2).pose(0.01));
}

/// Compares everything that can be read from two maps, to the bit.
void expectSame(const VoxMap& a, const VoxMap& b) {
  ASSERT_EQ(a.brickCount(), b.brickCount());
  EXPECT_EQ(a.voxel_m(), b.voxel_m());
  EXPECT_EQ(a.band_m(), b.band_m());
  EXPECT_EQ(a.quantum_m(), b.quantum_m());
  EXPECT_EQ(a.bounds().min, b.bounds().min);
  EXPECT_EQ(a.bounds().max, b.bounds().max);
  EXPECT_EQ(a.sampleError_m(), b.sampleError_m());
  RandomPoints random(7);
  for (int n = 0; n < 5000; ++n) {
    const Vec3 p = a.bounds().center() + random.inBox(0.8 * a.bounds().size());
    ASSERT_EQ(a.distance(p), b.distance(p));
    ASSERT_EQ(a.normal(p), b.normal(p));
    ASSERT_EQ(a.lowerBound(p), b.lowerBound(p));
    ASSERT_EQ(a.leastDistance(p), b.leastDistance(p));
    ASSERT_EQ(a.owner(p), b.owner(p));
  }
}

class VoxMapCacheTest : public testing::Test {
 protected:
  VoxMap build(const Mesh& mesh, MeshReport* report = nullptr) {
    return cache_.build(mesh, kCachedSettings, "hub", {}, report);
  }
  /// The map that is built if `bytes` replace the content of part()'s file.
  VoxMap rebuilt(const std::string& bytes) {
    warnings_.clear();
    test::write(cache_.fileOf(part(), kCachedSettings), bytes);
    return build(part());
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
  VoxMapCache cache_{folder_.path() / "maps", [this](const std::string& w) { warnings_.push_back(w); }};
};

TEST_F(VoxMapCacheTest, TheSecondMapIsReadFromTheFileWithTheSameBits) {
  const VoxMap direct = buildVoxMap(part(), kCachedSettings);
  expectSame(build(part()), direct);
  ASSERT_TRUE(fs::exists(cache_.fileOf(part(), kCachedSettings)));
  int calls = 0;
  const VoxMap kept =
      cache_.build(part(), kCachedSettings, "hub", [&](std::string_view, double) { ++calls; });
  EXPECT_EQ(calls, 0);
  expectSame(kept, direct);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(VoxMapCacheTest, AFaultyMeshKeepsItsReport) {
  Mesh open = part();
  open.triangles.resize(open.triangles.size() - 3);
  MeshReport first, second;
  const VoxMap built = build(open, &first);
  expectSame(build(open, &second), built);
  EXPECT_TRUE(first.signed_by_winding);
  EXPECT_EQ(describe(first), describe(second));
  EXPECT_EQ(first.certain_share, second.certain_share);
}

TEST_F(VoxMapCacheTest, ADifferenceInTheLastBitGivesAnotherFile) {
  Mesh other = part();
  other.vertices[5].x() = std::nextafter(other.vertices[5].x(), 1.0);
  Mesh turned = part();
  std::rotate(turned.triangles[0].begin(), turned.triangles[0].begin() + 1, turned.triangles[0].end());
  std::set<fs::path> files = {cache_.fileOf(part(), kCachedSettings), cache_.fileOf(other, kCachedSettings),
                              cache_.fileOf(turned, kCachedSettings), cache_.fileOf(part(), {0.5e-3, 3}),
                              cache_.fileOf(part(), {0.4e-3, 4})};
  EXPECT_EQ(files.size(), 5u);
}

TEST_F(VoxMapCacheTest, EveryDamagedFileIsBuiltAgainWithAWarningAndReplaced) {
  const VoxMap direct = build(part());
  const fs::path file = cache_.fileOf(part(), kCachedSettings);
  const std::string good = test::bytesOf(file);
  std::vector<std::string> damaged = {"", "vpscache", std::string(5000, 'x'), good + "x"};
  for (const std::size_t length : {good.size() / 2, good.size() - 1, std::size_t{144}, std::size_t{150}})
    damaged.push_back(good.substr(0, length));
  // Flips one bit in each byte of the header, and in some bytes of the rest.
  for (std::size_t i = 0; i < good.size(); i += i < 160 ? 1 : good.size() / 40) {
    damaged.push_back(good);
    damaged.back()[i] = static_cast<char>(damaged.back()[i] ^ (1 << i % 8));
  }
  for (const std::string& bytes : damaged) {
    const VoxMap map = rebuilt(bytes);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("built again"), std::string::npos) << warnings_[0];
    ASSERT_EQ(map.distance({0.002, 0, 0}), direct.distance({0.002, 0, 0}));
    ASSERT_EQ(test::bytesOf(file), good);
  }
}

TEST_F(VoxMapCacheTest, AFileOfAnotherPartUnderItsNameIsNotTrusted) {
  build(makeBox({0.01, 0.01, 0.01}));
  const VoxMap map = rebuilt(test::bytesOf(cache_.fileOf(makeBox({0.01, 0.01, 0.01}), kCachedSettings)));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("made from other data"), std::string::npos) << warnings_[0];
  expectSame(map, buildVoxMap(part(), kCachedSettings));
}

TEST_F(VoxMapCacheTest, AFolderThatCannotBeCreatedGivesAWarningAndTheMap) {
  test::write(folder_.path() / "maps", "a file where the folder should be");
  expectSame(build(part()), buildVoxMap(part(), kCachedSettings));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("could not be kept"), std::string::npos) << warnings_[0];
  EXPECT_EQ(test::bytesOf(folder_.path() / "maps"), "a file where the folder should be");
}

TEST_F(VoxMapCacheTest, InputThatBuildingRefusesIsRefusedAndNotStored) {
  EXPECT_THROW(build(Mesh{}), LoadError);
  EXPECT_FALSE(fs::exists(folder_.path() / "maps"));
}

TEST_F(VoxMapCacheTest, ConcurrentWritersLeaveOneWholeFile) {
  std::vector<std::thread> threads;
  std::vector<VoxMap> maps(4);
  for (VoxMap& map : maps)
    threads.emplace_back([&] {
      const VoxMapCache own(folder_.path() / "maps");
      for (int n = 0; n < 5; ++n) map = own.build(part(), kCachedSettings);
    });
  for (std::thread& t : threads) t.join();
  for (const VoxMap& map : maps) expectSame(map, maps[0]);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path() / "maps"), {}), 1);
  expectSame(build(part()), maps[0]);
  EXPECT_TRUE(warnings_.empty());
}

constexpr PointShellSettings kPoints = {1e-3, 0.35};

PointShell shellOf(const VoxMapCache& cache, const Mesh& mesh) {
  return cache.buildShell(mesh, Solid(mesh), kPoints);
}

void expectSame(const PointShell& a, const PointShell& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.inward, b.inward);
  EXPECT_EQ(a.area_m2, b.area_m2);
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.spacing_m, b.spacing_m);
  EXPECT_EQ(a.leaf_blocks, b.leaf_blocks);
  EXPECT_EQ(a.memoryBytes(), b.memoryBytes());
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].center, b.nodes[i].center);
    EXPECT_EQ(a.nodes[i].radius_m, b.nodes[i].radius_m);
    EXPECT_EQ(a.nodes[i].skip, b.nodes[i].skip);
  }
}

TEST_F(VoxMapCacheTest, TheSecondShellIsReadFromTheFileWithTheSameBits) {
  const PointShell direct = buildPointShell(Solid(part()), kPoints);
  expectSame(shellOf(cache_, part()), direct);
  const fs::path file = cache_.shellFileOf(part(), kPoints);
  ASSERT_TRUE(fs::exists(file));
  const auto written = fs::last_write_time(file);
  expectSame(shellOf(cache_, part()), direct);
  EXPECT_GT(fs::last_write_time(file), written) << "its use was not noted";
  EXPECT_NE(cache_.shellFileOf(part(), {0.9e-3, 0.35}), file);
  EXPECT_NE(cache_.shellFileOf(part(), {1e-3, 0.3}), file);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(VoxMapCacheTest, EveryDamagedShellIsBuiltAgainWithAWarningAndReplaced) {
  const PointShell direct = shellOf(cache_, part());
  const fs::path file = cache_.shellFileOf(part(), kPoints);
  const std::string good = test::bytesOf(file);
  std::vector<std::string> damaged = {"", std::string(5000, 'x'), good + "x",
                                      good.substr(0, good.size() - 60)};
  for (std::size_t i = 0; i < good.size(); i += i < 60 ? 1 : good.size() / 40) {
    damaged.push_back(good);
    damaged.back()[i] = static_cast<char>(damaged.back()[i] ^ (1 << i % 8));
  }
  for (const std::string& bytes : damaged) {
    warnings_.clear();
    test::write(file, bytes);
    expectSame(shellOf(cache_, part()), direct);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("built again"), std::string::npos) << warnings_[0];
    ASSERT_EQ(test::bytesOf(file), good);
  }
}

Mesh cube(int i) {
  return makeBox(Vec3::Constant(0.01 + 1e-4 * i));
}

TEST_F(VoxMapCacheTest, TheLongestUnusedFilesGoFirstWhenTheFolderIsFull) {
  build(cube(0));
  const std::uint64_t each = fs::file_size(cache_.fileOf(cube(0), kCachedSettings));
  test::write(folder_.path() / "maps" / "notes.txt", std::string(10 * each, 'x'));  // not the cache's own
  const VoxMapCache small(folder_.path() / "maps", {}, 4 * each + each / 2);
  const auto isKept = [&](int i) { return fs::exists(small.fileOf(cube(i), kCachedSettings)); };
  for (int i = 1; i <= 3; ++i) {
    (void)small.build(cube(i), kCachedSettings);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // clocks of file systems are coarse
  }
  (void)small.build(cube(0), kCachedSettings);  // used again
  for (int i = 0; i <= 3; ++i) EXPECT_TRUE(isKept(i)) << i;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  (void)small.build(cube(4), kCachedSettings);
  EXPECT_TRUE(isKept(0) && isKept(3) && isKept(4));
  EXPECT_FALSE(isKept(1)) << "the longest unused";
  EXPECT_TRUE(fs::exists(folder_.path() / "maps" / "notes.txt"));
}

TEST_F(VoxMapCacheTest, AFullDiskGivesOneWarningAndTheModels) {
  // Writing beyond the limit fails, as on a full disk.
  struct sigaction before = {}, ignored = {};
  ignored.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &ignored, &before);
  rlimit old = {};
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit tight = {1000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);
  const VoxMap first = build(cube(1)), second = build(cube(2));
  const PointShell shell = shellOf(cache_, cube(1));
  setrlimit(RLIMIT_FSIZE, &old);
  sigaction(SIGXFSZ, &before, nullptr);
  expectSame(first, buildVoxMap(cube(1), kCachedSettings));
  expectSame(second, buildVoxMap(cube(2), kCachedSettings));
  expectSame(shell, buildPointShell(Solid(cube(1)), kPoints));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("could not be kept"), std::string::npos) << warnings_[0];
  EXPECT_TRUE(fs::is_empty(folder_.path() / "maps")) << "part of a file was left";
}

}  // namespace
}  // namespace vps::test
