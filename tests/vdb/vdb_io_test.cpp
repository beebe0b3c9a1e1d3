// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps as .vdb files: files of saveVdb(), what other programs read from them, and level sets of other
// programs. The file has more than 400 lines because a second source would include OpenVDB, which takes a
// minute to compile.
#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "support/analytic.h"
#include "vps/errors.h"
#include "vps/query.h"
#include "vps/vdb.h"

namespace vps::test {
namespace {

constexpr double kVoxel_m = 0.5e-3;
constexpr VoxMapSettings kSettings = {kVoxel_m, 4};

class VdbFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("vps_vdb_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
    file_ = (folder_ / "part.vdb").string();
    openvdb::initialize();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }

  std::filesystem::path folder_;
  std::string file_;
};

TEST_F(VdbFile, ReloadsToTheSameBits) {
  const VoxMap map =
      buildVoxMap(transformed(makeTube(0.01, 0.006, 0.02, 64), RandomPoints(24).pose(0.01)), kSettings);
  saveVdb(map, file_);
  const VoxMap loaded = loadVdb(file_);
  expectSame(map, loaded);
}

TEST_F(VdbFile, ACookedMapKeepsItsOwnersAndMorePartsCanBeMounted) {
  const Mesh tube = makeTube(0.01, 0.006, 0.012, 64), pin = makeCylinder(0.005, 0.03, 64);
  const Mesh box = makeBox({0.01, 0.01, 0.01});
  const Pose X_box = Pose::translation({0.02, 0.01, 0});
  const VoxMap cooked = cookVoxMap({{&tube, {}}, {&pin, {}}}, kSettings);
  saveVdb(cooked, file_);
  const VoxMap loaded = loadVdb(file_);
  expectSame(cooked, loaded);
  RandomPoints random(25);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random.inBox({0.013, 0.013, 0.018});
    if (std::abs(cooked.distance(p)) < 2 * kVoxel_m) {
      ASSERT_EQ(cooked.owner(p), loaded.owner(p));
    }
  }
  expectSame(mountVoxMap(cooked, {&box, X_box}), mountVoxMap(loaded, {&box, X_box}));
}

TEST_F(VdbFile, AResampledMapKeepsItsErrorAndItsBounds) {
  const VoxMap tube = buildVoxMap(makeTube(0.01, 0.006, 0.012, 64), kSettings);
  const VoxMap moved = resampledVoxMap({&tube, RandomPoints(26).pose(0.01)}, kSettings);
  saveVdb(moved, file_);
  const VoxMap loaded = loadVdb(file_);
  EXPECT_GT(loaded.sampleError_m(), tube.sampleError_m());
  EXPECT_EQ(loaded.sampleError_m(), moved.sampleError_m());
  RandomPoints random(27);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = moved.bounds().center() + random.inBox(moved.bounds().size());
    // Resampling rounds a node that two bricks share in each brick; a file stores it once.
    ASSERT_NEAR(loaded.distance(p), moved.distance(p), 1.01 * moved.quantum_m());
    ASSERT_NEAR(loaded.leastDistance(p), moved.leastDistance(p), 1.01 * moved.quantum_m());
  }
  saveVdb(loaded, file_);
  expectSame(loaded, loadVdb(file_));
}

TEST_F(VdbFile, OtherProgramsReadAPlainLevelSet) {
  constexpr double kRadius_m = 0.008;
  const VoxMap map = buildVoxMap(makeSphere(kRadius_m, 5), kSettings);
  saveVdb(map, file_);
  openvdb::io::File file(file_);
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("surface"));
  ASSERT_NE(grid, nullptr);
  EXPECT_EQ(grid->getName(), "surface");
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(grid->background(), static_cast<float>(map.band_m()));
  EXPECT_EQ(grid->transform(), *openvdb::math::Transform::createLinearTransform(kVoxel_m));
  for (auto value = grid->cbeginValueOff(); value; ++value) ASSERT_EQ(std::abs(*value), grid->background());
  int active = 0;
  for (auto value = grid->cbeginValueOn(); value; ++value, ++active) {
    const openvdb::Vec3d p = grid->indexToWorld(value.getCoord());
    ASSERT_LT(std::abs(*value), grid->background());
    // Half a quantum, and the facets: 20480 triangles lie less than 4 um inside.
    ASSERT_NEAR(*value, p.length() - kRadius_m, 0.51 * map.quantum_m() + 4e-6);
  }
  EXPECT_GT(active, 10000);
  EXPECT_EQ(grid->tree().getValue(openvdb::Coord(0, 0, 0)), -grid->background());
}

TEST_F(VdbFile, ReplacesAnEarlierFileWhole) {
  saveVdb(buildVoxMap(makeBox({0.01, 0.01, 0.01}), kSettings), file_);
  const VoxMap sphere = buildVoxMap(makeSphere(0.004, 3), kSettings);
  saveVdb(sphere, file_);
  expectSame(sphere, loadVdb(file_));
}

TEST_F(VdbFile, WritersOfOneFileDoNotMix) {
  const VoxMap first = buildVoxMap(makeBox({0.01, 0.01, 0.01}), kSettings);
  const VoxMap second = buildVoxMap(makeSphere(0.004, 3), kSettings);
  const auto writeOften = [&](const VoxMap& map) {
    for (int n = 0; n < 40; ++n) saveVdb(map, file_);
  };
  std::thread other([&] { EXPECT_NO_THROW(writeOften(second)); });
  EXPECT_NO_THROW(writeOften(first));
  other.join();
  const double d = loadVdb(file_).distance({0, 0, 0.0045});
  EXPECT_TRUE(d == first.distance({0, 0, 0.0045}) || d == second.distance({0, 0, 0.0045})) << d;
  for (const auto& left : std::filesystem::directory_iterator(folder_)) EXPECT_EQ(left.path(), file_);
}

TEST_F(VdbFile, EveryCutIsRefused) {
  saveVdb(buildVoxMap(makeSphere(0.002, 2), {kVoxel_m, 3}), file_);
  ASSERT_NO_THROW(static_cast<void>(loadVdb(file_)));
  const std::string whole = bytesOf(file_);
  const std::string cut = (folder_ / "cut.vdb").string();
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 400) {
    write(cut, whole.substr(0, length));
    ASSERT_THROW(static_cast<void>(loadVdb(cut)), LoadError) << length << " of " << whole.size();
  }
}

TEST_F(VdbFile, EveryWrongByteIsRefused) {
  saveVdb(buildVoxMap(makeSphere(0.002, 2), {kVoxel_m, 3}), file_);
  const std::string whole = bytesOf(file_);
  const std::string wrong = (folder_ / "wrong.vdb").string();
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 300) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
    write(wrong, bytes);
    ASSERT_THROW(static_cast<void>(loadVdb(wrong)), LoadError) << at << " of " << whole.size();
  }
}

TEST_F(VdbFile, OtherFilesAreRefused) {
  EXPECT_THROW(static_cast<void>(loadVdb((folder_ / "missing.vdb").string())), LoadError);
  write(file_, "");
  EXPECT_THROW(static_cast<void>(loadVdb(file_)), LoadError);
  write(file_, std::string(10000, 'x'));
  EXPECT_THROW(static_cast<void>(loadVdb(file_)), LoadError);
  EXPECT_THROW(
      saveVdb(buildVoxMap(makeBox({0.01, 0.01, 0.01}), kSettings), (folder_ / "no/such.vdb").string()),
      LoadError);
  EXPECT_THROW(saveVdb(VoxMap(), file_), LoadError);
}

// Level sets of other programs

using openvdb::FloatGrid;

constexpr double kRadius_m = 0.008;
const Vec3 kCenter_M(0.3e-3, -0.7e-3, 1.1e-3);

/// A level set with the distance to a ball at every node of a band, made by OpenVDB.
FloatGrid::Ptr ball(double half_width = 4) {
  return openvdb::tools::createLevelSetSphere<FloatGrid>(
      static_cast<float>(kRadius_m),
      openvdb::Vec3f(openvdb::Vec3d(kCenter_M.x(), kCenter_M.y(), kCenter_M.z())),
      static_cast<float>(kVoxel_m), static_cast<float>(half_width));
}

/// Moves a grid's lattice; its nodes are then at p_F = X_FM p_M.
void place(openvdb::GridBase& grid, const Pose& X_FM) {
  openvdb::Mat4d m = openvdb::Mat4d::identity();
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 3; ++k) m(axis, k) = kVoxel_m * X_FM.R(k, axis);
  for (int k = 0; k < 3; ++k) m(3, k) = X_FM.p[k];
  grid.setTransform(openvdb::math::Transform::createLinearTransform(m));
}

template <typename Change>
void changeAll(FloatGrid& grid, Change change) {
  for (auto value = grid.beginValueAll(); value; ++value) value.setValue(change(*value));
}

class ForeignVdb : public VdbFile {
 protected:
  void store(const openvdb::GridPtrVec& grids, bool has_statistics = true) const {
    openvdb::io::File file(file_);
    file.setGridStatsMetadataEnabled(has_statistics);
    file.write(grids);
  }
  VoxMap stored(const openvdb::GridBase::Ptr& grid) const {
    store({grid});
    return loadVdb(file_);
  }
  /// The reason for which the file is refused.
  [[nodiscard]] std::string complaint(const std::string& name = "") const {
    try {
      static_cast<void>(loadVdb(file_, name));
    } catch (const LoadError& error) {
      return error.what();
    }
    return "taken";
  }
  [[nodiscard]] std::string complaintAbout(const openvdb::GridBase::Ptr& grid) const {
    store({grid});
    return complaint();
  }

  /// The greatest error against the ball in the band, except in its last two voxels, where saturated nodes
  /// enter the interpolation.
  static double worstError_m(const VoxMap& map, const Pose& X_FM, double band_m) {
    RandomPoints random(40);
    double worst_m = 0;
    for (int n = 0; n < 30000; ++n) {
      const Vec3 direction = random.inBox(Vec3::Ones()).normalized();
      const double d = (band_m - 2 * kVoxel_m) * random.unit();
      const Vec3 p_M = kCenter_M + (kRadius_m + d) * direction;
      worst_m = std::max(worst_m, std::abs(map.distance(X_FM * p_M) - d));
    }
    return worst_m;
  }
  /// Trilinear on a ball: h^2/8 times 2/r, r least at the inner edge; half a quantum; and the rounding of
  /// voxel size and radius to floats, 6e-8 of the distance from the grid's origin.
  static double interpolation_m(const VoxMap& map, double band_m) {
    return kVoxel_m * kVoxel_m / 8 * 2 / (kRadius_m - band_m) + 0.51 * map.quantum_m() + 2e-9;
  }
};

TEST_F(ForeignVdb, ABallReadsItsAnalyticDistanceInAnyNumberType) {
  for (const double half_width : {3.0, 4.0, 7.5, 12.0}) {
    const FloatGrid::Ptr grid = ball(half_width);
    const double band_m = half_width * kVoxel_m;
    const VoxMap map = stored(grid);
    EXPECT_NEAR(map.band_m(), band_m, 1e-6 * band_m);
    EXPECT_LT(worstError_m(map, Pose(), band_m), interpolation_m(map, band_m));
    const Vec3 half_m = Vec3::Constant(kRadius_m);  // zeros lie between nodes, which are up to 1.1 um wrong
    EXPECT_LT((map.bounds().min - (kCenter_M - half_m)).cwiseAbs().maxCoeff(), 0.02 * kVoxel_m);
    EXPECT_LT((map.bounds().max - (kCenter_M + half_m)).cwiseAbs().maxCoeff(), 0.02 * kVoxel_m);

    const VoxMap from_doubles = stored(std::make_shared<openvdb::DoubleGrid>(*grid));
    expectSame(map, from_doubles);
    grid->setSaveFloatAsHalf(true);
    // 11 bits: half a step at the band's end is at most 2^-11 of the band.
    EXPECT_LT(worstError_m(stored(grid), Pose(), band_m),
              interpolation_m(map, band_m) + std::ldexp(band_m, -11));
  }
}

TEST_F(ForeignVdb, AWideBandIsKeptUpTo32Voxels) {
  const VoxMap map = stored(ball(40));
  EXPECT_NEAR(map.band_m(), 32 * kVoxel_m, 1e-6 * kVoxel_m);
  // Deep inside all paths meet at the centre; the surface is far from it.
  EXPECT_LT(worstError_m(map, Pose(), 6 * kVoxel_m), interpolation_m(map, 6 * kVoxel_m));
}

TEST_F(ForeignVdb, ARotatedOrMovedGridIsReadAtItsPose) {
  for (const Pose& X_FM :
       {Pose::translation({0.25e-3, 0.1e-3, -0.4e-3}), Pose::translation(Vec3(3, 16, -5) * kVoxel_m),
        RandomPoints(41).pose(0.02), Pose(Quat(0, 1, 0, 0), Vec3::Zero())}) {
    const FloatGrid::Ptr grid = ball();
    place(*grid, X_FM);
    store({grid});
    const double band_m = 4 * kVoxel_m;
    const VoxMap map = loadVdb(file_);
    // Interpolated twice, with the rounding of positions in the vectorised reading: 1e-4 voxel.
    EXPECT_LT(worstError_m(map, X_FM, band_m), 2 * interpolation_m(map, band_m) + 1e-4 * kVoxel_m);
    // The same without resampling.
    const PlacedVdb placed = loadPlacedVdb(file_);
    EXPECT_LT(worstError_m(placed.map, Pose(), band_m), interpolation_m(map, band_m));
    EXPECT_LT((placed.X_FM.R - X_FM.R).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(placed.X_FM.p, X_FM.p);
  }
}

TEST_F(ForeignVdb, AThinBandIsExtended) {
  for (const double half_width : {1.01, 1.5, 2.0, 2.5}) {
    const VoxMap map = stored(ball(half_width));
    EXPECT_NEAR(map.band_m(), 3 * kVoxel_m, 1e-6 * kVoxel_m);
    RandomPoints random(42);
    double known_m = 0, worst_m = 0;
    for (int n = 0; n < 30000; ++n) {
      const double d = 2.5 * kVoxel_m * random.unit();
      const double error_m =
          std::abs(map.distance(kCenter_M + (kRadius_m + d) * random.inBox(Vec3::Ones()).normalized()) - d);
      worst_m = std::max(worst_m, error_m);
      // The point is in a cell whose nodes were all in the old band.
      if (std::abs(d) < (half_width - std::sqrt(3.0)) * kVoxel_m) known_m = std::max(known_m, error_m);
    }
    EXPECT_LT(known_m, interpolation_m(map, 3 * kVoxel_m)) << half_width;
    // A first-order solution. Measured: 0.11 to 0.2 voxel too far, and only as deep as the new band.
    EXPECT_LT(worst_m, 0.25 * kVoxel_m) << half_width;
  }
}

TEST_F(ForeignVdb, AnInsideWithoutSignsGetsThem) {
  const FloatGrid::Ptr grid = ball();
  for (auto value = grid->beginValueOff(); value; ++value) value.setValue(grid->background());
  expectSame(stored(ball()), stored(grid));
}

TEST_F(ForeignVdb, OfSeveralGridsTheOnlyLevelSetOrTheNamedOneIsRead) {
  const FloatGrid::Ptr a = ball(), b = ball(5), fog = FloatGrid::create(0);
  const auto colour = openvdb::Vec3SGrid::create();
  a->setName("a"), b->setName("b"), fog->setName("density"), colour->setName("Cd");
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  fog->tree().setValue({0, 0, 0}, 1);
  const VoxMap map_a = stored(a), map_b = stored(b);
  store({fog, a, colour});
  expectSame(loadVdb(file_), map_a);
  store({fog, a, b});
  expectSame(loadVdb(file_, "b"), map_b);
  EXPECT_NE(complaint().find("several level sets; name one of 'a', 'b'"), std::string::npos) << complaint();
  EXPECT_NE(complaint("c").find("no grid 'c'; it holds 'density', 'a', 'b'"), std::string::npos)
      << complaint("c");
  EXPECT_NE(complaint("density").find("'density' is a fog volume"), std::string::npos)
      << complaint("density");
  // A grid without a class is classified by its values.
  a->setGridClass(openvdb::GRID_UNKNOWN);
  store({a});
  expectSame(loadVdb(file_), map_a);
  // Files that were written as a stream have no table of their grids.
  {
    std::ofstream out(file_, std::ios::binary);
    openvdb::io::Stream(out).write(openvdb::GridPtrVec{fog, b, colour});
  }
  expectSame(loadVdb(file_), map_b);
  // Two grids that share a tree.
  const FloatGrid::Ptr shared = openvdb::gridPtrCast<FloatGrid>(b->copyGrid());
  shared->setName("shared");
  store({b, shared});
  expectSame(loadVdb(file_, "shared"), map_b);
}

TEST_F(ForeignVdb, OtherGridsAreRefusedWithARemedy) {
  const auto expect = [&](const openvdb::GridBase::Ptr& grid, const char* text) {
    const std::string said = complaintAbout(grid);
    EXPECT_NE(said.find(text), std::string::npos) << said;
  };
  store({});
  EXPECT_NE(complaint().find("holds no grids"), std::string::npos) << complaint();
  expect(FloatGrid::create(1), "is empty");
  expect(openvdb::Int32Grid::create(0), "is of type int32; a level set of floats is needed");

  FloatGrid::Ptr grid = ball();
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  expect(grid, "is a fog volume; convert it");
  grid = FloatGrid::create(0);
  grid->fill(openvdb::CoordBBox({0, 0, 0}, {20, 20, 20}), 1);
  grid->tree().setValue({3, 3, 3}, 0.5F);
  expect(grid, "looks like a fog volume");

  grid = ball();
  changeAll(*grid, [](float d) { return std::abs(d); });
  expect(grid, "no value is negative");
  grid = ball();
  openvdb::tools::changeBackground(grid->tree(), -grid->background());
  expect(grid, "is inside out");
  grid = ball();
  grid->tree().setValue({0, 0, 16}, std::nanf(""));
  expect(grid, "not numbers");
  for (const bool is_active : {true, false}) {  // where no leaf is
    grid = ball();
    grid->tree().addTile(1, {64, 0, 0}, std::nanf(""), is_active);
    expect(grid, "not numbers");
  }
  grid = ball(2);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(2.5 * kVoxel_m));
  expect(grid, "band of 0.8 voxels; at least 1 voxel is needed");

  grid = ball();
  auto transform = openvdb::math::Transform::createLinearTransform(kVoxel_m);
  transform->preScale(openvdb::Vec3d(1, 1, 2));
  grid->setTransform(transform);
  expect(grid, "voxels of 0.5 x 0.5 x 1 mm; resample it to cubes");
  transform = openvdb::math::Transform::createLinearTransform(kVoxel_m);
  transform->preScale(openvdb::Vec3d(1, 1, -1));
  grid->setTransform(transform);
  expect(grid, "mirrored");
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(10)), 0.5, 1, kVoxel_m));
  expect(grid, "frustum");
  openvdb::Mat4d shear = openvdb::Mat4d::identity();
  shear(0, 0) = shear(1, 1) = 0.8 * kVoxel_m, shear(0, 1) = shear(1, 0) = 0.6 * kVoxel_m;
  shear(2, 2) = kVoxel_m;
  grid->setTransform(openvdb::math::Transform::createLinearTransform(shear));
  expect(grid, "sheared");
}

TEST_F(ForeignVdb, AFileThatWouldNotFitInMemoryIsRefusedBeforeItIsRead) {
  FloatGrid::Ptr grid = ball();
  grid->insertMeta("file_mem_bytes", openvdb::Int64Metadata(std::int64_t{1} << 40));
  store({grid}, false);
  EXPECT_NE(complaint().find("needs 1024 GiB for grid '[0]', the limit is 4 GiB; resample"),
            std::string::npos)
      << complaint();
  // Two leaves as far apart as can be.
  grid = ball();
  grid->tree().setValue({1 << 24, 1 << 24, 1 << 24}, 0.0F);
  store({grid});
  EXPECT_NE(complaint().find("for its directory"), std::string::npos) << complaint();
  grid->tree().setValue({-(1 << 30), 0, 0}, 0.0F);
  store({grid});
  EXPECT_NE(complaint().find("too many voxels from its own origin"), std::string::npos) << complaint();
}

TEST_F(ForeignVdb, EveryCutIsRefused) {
  store({ball(3)});
  const std::string whole = bytesOf(file_);
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 150) {
    write(file_, whole.substr(0, length));
    ASSERT_THROW(static_cast<void>(loadVdb(file_)), LoadError) << length << " of " << whole.size();
  }
}

/// Level sets whose values are not distances.
std::vector<std::pair<const char*, FloatGrid::Ptr>> notMetric() {
  const auto of = [](double band, auto value) {  // on the nodes of a box, where it is below the band
    const FloatGrid::Ptr grid = FloatGrid::create(static_cast<float>(band * kVoxel_m));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(kVoxel_m));
    for (int x = -30; x <= 30; ++x)
      for (int y = -30; y <= 30; ++y)
        for (int z = -30; z <= 30; ++z) {
          const double d = value(kVoxel_m * Vec3(x, y, z));
          if (std::abs(d) < band * kVoxel_m)
            grid->tree().setValue({x, y, z}, static_cast<float>(d));
          else if (d < 0)
            grid->tree().setValueOff({x, y, z}, static_cast<float>(-band * kVoxel_m));
        }
    return grid;
  };
  const auto balls = [](const Vec3& p) {  // two that overlap, blended into one
    const double a = sphereDistance(p - Vec3(0.003, 0, 0), 0.005),
                 b = sphereDistance(p + Vec3(0.003, 0, 0), 0.004);
    const double k = 0.002, t = std::clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
    return b + t * (a - b) - k * t * (1 - t);
  };
  const FloatGrid::Ptr half = ball(), twice = ball(), both = ball();
  changeAll(*half, [](float d) { return 0.5F * d; });
  openvdb::tools::changeBackground(half->tree(), 0.5F * half->background());
  changeAll(*twice, [](float d) { return 2 * d; });
  openvdb::tools::changeBackground(twice->tree(), 2 * twice->background());
  const float band = both->background();  // half as steep, with the old band: a step at its end
  for (auto value = both->beginValueOn(); value; ++value) value.setValue(std::min(0.5F * *value, band));
  RandomPoints noise(43);
  return {{"half", half},
          {"twice", twice},
          {"half with a step", both},
          {"melted balls", of(4, balls)},
          {"noise", of(3, [&](const Vec3& p) { return sphereDistance(p, 0.006) + 0.4e-3 * noise.unit(); })},
          {"a cut ball", of(4, [&](const Vec3& p) { return p.x() > 0.002 ? 1 : sphereDistance(p, 0.006); })}};
}

class NonMetricVdb : public ForeignVdb {};

TEST_F(NonMetricVdb, CulledAndCoherentAnswersAreTheExhaustiveOne) {
  const PointShell shell = buildPointShell(makeBox({0.004, 0.003, 0.005}), {0.25e-3, 0.35});
  for (const auto& [name, grid] : notMetric()) {
    const VoxMap map = stored(grid);
    ContactSet culled(shell.size()), coherent(shell.size()), all(shell.size());
    RandomPoints random(44);
    std::size_t touching = 0, read = 0, visited = 0;
    for (const double cutoff_m : {0.0, 30e-6, 0.9 * map.band_m()}) {
      QueryMemory memory(map, shell);
      Pose X_MP = random.pose(0.008);
      for (int n = 0; n < 250; ++n) {
        if (n % 25 == 0) X_MP = random.pose(0.012);
        X_MP.p += random.inBox(Vec3::Constant(n % 3 == 0 ? 2e-6 : 0.2e-3));
        QueryOptions options;
        options.cutoff_m = cutoff_m;
        const QueryResult a = queryContacts(map, shell, X_MP, options, culled);
        queryContacts(map, shell, X_MP, options, coherent, &memory);
        options.is_exhaustive = true;
        const QueryResult b = queryContacts(map, shell, X_MP, options, all);
        for (const ContactSet* some : {&culled, &coherent}) {
          ASSERT_EQ(some->contacts.size(), all.contacts.size()) << name << ", cutoff " << cutoff_m;
          for (std::size_t i = 0; i < all.contacts.size(); ++i) {
            const Contact &c = some->contacts[i], &e = all.contacts[i];
            ASSERT_TRUE(c.id == e.id && c.distance_m == e.distance_m && c.n_M == e.n_M) << name;
          }
        }
        ASSERT_LE(a.min_distance_m, b.min_distance_m) << name;
        ASSERT_EQ(queryDistance(map, shell, X_MP).min_distance_m < map.band_m() - map.sampleError_m()
                      ? queryDistance(map, shell, X_MP).min_distance_m
                      : b.min_distance_m,
                  b.min_distance_m)
            << name;
        touching += all.contacts.size();
        read += a.points_tested;
        visited += b.points_tested;
      }
    }
    EXPECT_GT(touching, 5000u) << name;
    EXPECT_LT(read, visited) << name;
  }
}

TEST_F(NonMetricVdb, NoReadingIsBelowItsBound) {
  for (const auto& [name, grid] : notMetric()) {
    const VoxMap map = stored(grid);
    RandomPoints random(45);
    for (int n = 0; n < 100000; ++n) {
      const Vec3 p = random.inBox(Vec3::Constant(0.02)), direction = random.inBox(Vec3::Constant(0.01)),
                 way = direction * random.unit();
      const double least_m = std::min(map.leastDistance(p) - way.norm(), map.band_m()) - map.sampleError_m();
      ASSERT_GE(map.distance(p + way), least_m)
          << name << " at " << p.transpose() << " by " << way.transpose();
    }
  }
}

TEST_F(NonMetricVdb, BoundsOfTrueDistancesAreNearlyTight) {
  const VoxMap map = stored(ball());
  // Paths over grid cells cost 0.1135 of the band, for any distances (field_bounds.h).
  EXPECT_LT(map.sampleError_m(), (0.8661 + 0.1137 * 4) * kVoxel_m + map.quantum_m());
  // Far away, bounds still distinguish far from near, and outside from inside.
  saveVdb(buildVoxMap(makeSphere(kRadius_m, 4), {0.1e-3, 4}), file_);
  openvdb::io::File file(file_);
  file.open();
  const openvdb::GridBase::Ptr surface = file.readGrid("surface");
  file.close();
  surface->clearMetadata();
  const VoxMap fine = stored(surface);
  EXPECT_GT(fine.lowerBound({0.03, 0, 0}), 0.02);
  EXPECT_GT(fine.lowerBound(Vec3::Zero()), 0.6 * kRadius_m);
}

}  // namespace
}  // namespace vps::test
