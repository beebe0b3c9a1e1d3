// SPDX-License-Identifier: BSD-3-Clause
// OpenVDB as the rival, and NanoVDB if it is installed. Only this file includes their headers, which are slow
// to compile.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/GridTransformer.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#ifdef VPS_HAS_NANOVDB
#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#endif

#include <cmath>
#include <mutex>
#include <vector>

#include "rival.h"

namespace vps::bench {
namespace {

using openvdb::FloatGrid;

void initializeOpenVdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

/// A mesh in the form of meshToVolume: vertices in units of voxels.
class MeshInVoxels {
 public:
  MeshInVoxels(const Mesh& mesh, double voxel_m) : mesh_(mesh), per_voxel_(1 / voxel_m) {}
  [[nodiscard]] std::size_t polygonCount() const { return mesh_.triangles.size(); }
  [[nodiscard]] std::size_t pointCount() const { return mesh_.vertices.size(); }
  [[nodiscard]] static std::size_t vertexCount(std::size_t) { return 3; }
  void getIndexSpacePoint(std::size_t triangle, std::size_t corner, openvdb::Vec3d& p) const {
    const Vec3& v = mesh_.vertices[mesh_.triangles[triangle][corner]];
    p = {v.x() * per_voxel_, v.y() * per_voxel_, v.z() * per_voxel_};
  }

 private:
  const Mesh& mesh_;
  double per_voxel_;
};

class OpenVdbField final : public RivalField {
 public:
  OpenVdbField(const Mesh& mesh, const RivalFieldSettings& settings) : voxel_m_(settings.voxel_m) {
    initializeOpenVdb();
    const auto band = static_cast<float>(settings.band_voxels);
    const int flags = settings.renormalize ? 0 : openvdb::tools::DISABLE_RENORMALIZATION;
    grid_ = openvdb::tools::meshToVolume<FloatGrid>(
        MeshInVoxels(mesh, settings.voxel_m),
        *openvdb::math::Transform::createLinearTransform(settings.voxel_m), band, band, flags);
  }
  explicit OpenVdbField(const std::string& name) {
    initializeOpenVdb();
    openvdb::io::File file(name);
    file.open();
    grid_ = openvdb::gridPtrCast<FloatGrid>(file.readGrid("surface"));
    voxel_m_ = grid_->voxelSize()[0];
  }
  [[nodiscard]] std::size_t memoryBytes() const override { return grid_->memUsage(); }
  [[nodiscard]] double node(int x, int y, int z) const override { return grid_->tree().getValue({x, y, z}); }
  [[nodiscard]] const FloatGrid& grid() const { return *grid_; }
  [[nodiscard]] double voxel_m() const { return voxel_m_; }

 private:
  double voxel_m_ = 0;
  FloatGrid::Ptr grid_;
};

const OpenVdbField& asOpenVdb(const RivalField& field) {
  return dynamic_cast<const OpenVdbField&>(field);
}

/// The part that all ways of reading share: the transform into voxels, and the sums over touching points.
class PointLoop : public RivalQuery {
 public:
  PointLoop(const PointShell& shell, double voxel_m, double far_m)
      : shell_(shell), voxel_m_(voxel_m), far_m_(far_m) {}

 protected:
  /// Visits every point: calls distanceAt(x) [m] for x in voxels, and gradientAt(x), a vector of any length,
  /// for points that touch.
  template <typename DistanceAt, typename GradientAt>
  Answer visit(const Pose& X_MP, DistanceAt distanceAt, GradientAt gradientAt) const {
    const Mat3 R = X_MP.R / voxel_m_;
    const Vec3 p = X_MP.p / voxel_m_;
    Answer answer;
    answer.least_m = far_m_;
    for (std::size_t i = 0; i < shell_.points.size(); ++i) {
      const Vec3 x = R * shell_.points[i] + p;
      const double distance_m = distanceAt(x);
      if (distance_m < answer.least_m) answer.least_m = distance_m;
      if (!(distance_m < 0)) continue;
      ++answer.touching;
      const Vec3 gradient = gradientAt(x);
      const double length = gradient.norm();
      if (!(length > 0)) continue;  // a point that is deeper than the band has no gradient
      const Vec3 f = (kStiffness_N_per_m3 * shell_.area_m2[i] * -distance_m / length) * gradient;
      answer.F_Mo_M.f += f;
      answer.F_Mo_M.tau += (voxel_m_ * x).cross(f);
    }
    return answer;
  }

  template <typename DistanceAt>
  std::size_t count(const Pose& X_MP, double level_m, DistanceAt distanceAt) const {
    std::size_t below = 0;
    for (const Vec3& p : shell_.points) below += distanceAt((X_MP * p) / voxel_m_) < level_m;
    return below;
  }

 private:
  const PointShell& shell_;
  double voxel_m_, far_m_;
};

using Corners = float[2][2][2];

/// Gradient of the trilinear interpolant per voxel, at t within the cell.
Vec3 gradientOf(const Corners& d, const Vec3& t) {
  const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
  return {mix(mix(d[1][0][0] - d[0][0][0], d[1][0][1] - d[0][0][1], t.z()),
              mix(d[1][1][0] - d[0][1][0], d[1][1][1] - d[0][1][1], t.z()), t.y()),
          mix(mix(d[0][1][0] - d[0][0][0], d[0][1][1] - d[0][0][1], t.z()),
              mix(d[1][1][0] - d[1][0][0], d[1][1][1] - d[1][0][1], t.z()), t.x()),
          mix(mix(d[0][0][1] - d[0][0][0], d[0][1][1] - d[0][1][0], t.y()),
              mix(d[1][0][1] - d[1][0][0], d[1][1][1] - d[1][1][0], t.y()), t.x())};
}

class OpenVdbQuery final : public PointLoop {
 public:
  OpenVdbQuery(const OpenVdbField& field, const PointShell& shell, bool shared)
      : PointLoop(shell, field.voxel_m(), field.grid().background()), grid_(field.grid()), shared_(shared) {}

  Answer step(const Pose& X_MP) override { return shared_ ? stepShared(X_MP) : stepTwice(X_MP); }
  std::size_t countBelow(const Pose& X_MP, double level_m) override {
    const Accessor accessor = grid_.getConstAccessor();
    return count(X_MP, level_m, [&](const Vec3& x) {
      return BoxSampler::sample(accessor, openvdb::Vec3R(x.x(), x.y(), x.z()));
    });
  }

 private:
  using BoxSampler = openvdb::tools::BoxSampler;
  using Accessor = FloatGrid::ConstAccessor;

  static openvdb::Coord cellOf(const Vec3& x) {
    return openvdb::Coord::floor(openvdb::Vec3R(x.x(), x.y(), x.z()));
  }

  Answer stepTwice(const Pose& X_MP) const {
    const Accessor accessor = grid_.getConstAccessor();
    return visit(
        X_MP,
        [&](const Vec3& x) {
          return double{BoxSampler::sample(accessor, openvdb::Vec3R(x.x(), x.y(), x.z()))};
        },
        [&](const Vec3& x) {
          const openvdb::Coord cell = cellOf(x);
          Corners d;
          BoxSampler::getValues(d, accessor, cell);
          return gradientOf(d, x - Vec3(cell.x(), cell.y(), cell.z()));
        });
  }

  Answer stepShared(const Pose& X_MP) const {
    const Accessor accessor = grid_.getConstAccessor();
    Corners d;
    Vec3 t;
    return visit(
        X_MP,
        [&](const Vec3& x) {
          const openvdb::Coord cell = cellOf(x);
          t = x - Vec3(cell.x(), cell.y(), cell.z());
          BoxSampler::getValues(d, accessor, cell);
          return double{BoxSampler::trilinearInterpolation(d, openvdb::Vec3R(t.x(), t.y(), t.z()))};
        },
        [&](const Vec3&) { return gradientOf(d, t); });
  }

  const FloatGrid& grid_;
  bool shared_;
};

#ifdef VPS_HAS_NANOVDB
class NanoVdbQuery final : public PointLoop {
 public:
  NanoVdbQuery(const OpenVdbField& field, const PointShell& shell)
      : PointLoop(shell, field.voxel_m(), field.grid().background()),
        handle_(nanovdb::openToNanoVDB(field.grid())) {}

  Answer step(const Pose& X_MP) override {
    const auto accessor = handle_.grid<float>()->getAccessor();
    const auto sampler = nanovdb::createSampler<1>(accessor);  // keeps the last cell's eight values
    return visit(
        X_MP, [&](const Vec3& x) { return double{sampler(nanovdb::Vec3d(x.x(), x.y(), x.z()))}; },
        [&](const Vec3& x) {
          const auto g = sampler.gradient(nanovdb::Vec3d(x.x(), x.y(), x.z()));
          return Vec3(g[0], g[1], g[2]);
        });
  }

  std::size_t countBelow(const Pose& X_MP, double level_m) override {
    const auto accessor = handle_.grid<float>()->getAccessor();
    const auto sampler = nanovdb::createSampler<1>(accessor);
    return count(X_MP, level_m, [&](const Vec3& x) { return sampler(nanovdb::Vec3d(x.x(), x.y(), x.z())); });
  }

 private:
  nanovdb::GridHandle<nanovdb::HostBuffer> handle_;
};
#endif

}  // namespace

std::unique_ptr<RivalField> buildOpenVdb(const Mesh& mesh, const RivalFieldSettings& settings) {
  return std::make_unique<OpenVdbField>(mesh, settings);
}

std::unique_ptr<RivalField> readOpenVdb(const std::string& file) {
  return std::make_unique<OpenVdbField>(file);
}

std::unique_ptr<RivalQuery> openVdbQuery(const RivalField& field, const PointShell& shell, bool shared) {
  return std::make_unique<OpenVdbQuery>(asOpenVdb(field), shell, shared);
}

std::unique_ptr<RivalQuery> nanoVdbQuery([[maybe_unused]] const RivalField& field,
                                         [[maybe_unused]] const PointShell& shell) {
#ifdef VPS_HAS_NANOVDB
  return std::make_unique<NanoVdbQuery>(asOpenVdb(field), shell);
#else
  return nullptr;
#endif
}

std::size_t mergeOpenVdb(const RivalField& base, const RivalField& mounted, const Pose& X_BM) {
  const FloatGrid& part = asOpenVdb(mounted).grid();
  const auto placed = FloatGrid::create(part.background());
  placed->setGridClass(openvdb::GRID_LEVEL_SET);
  placed->setTransform(asOpenVdb(base).grid().transform().copy());
  // Both grids have the same voxel size, so the rotation is the same in voxels. OpenVDB uses row vectors.
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) matrix(row, col) = X_BM.R(col, row);
    matrix(3, row) = X_BM.p[row] / asOpenVdb(base).voxel_m();
  }
  openvdb::tools::GridTransformer(matrix).transformGrid<openvdb::tools::BoxSampler>(part, *placed);
  const auto merged = openvdb::tools::csgUnionCopy(asOpenVdb(base).grid(), *placed);
  return merged->activeVoxelCount();
}

}  // namespace vps::bench
