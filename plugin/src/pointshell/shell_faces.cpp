// SPDX-License-Identifier: BSD-3-Clause
// Blue-noise points on faces: dart throwing (Cook 1986) from area-stratified candidates, then a fill pass
// that proves the covering radius triangle by triangle. Darts alone leave holes, and filling alone would
// reproduce the triangulation; together they give random points with a least and a greatest gap.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/normals.h"
#include "pointshell/shell_grid.h"
#include "pointshell/shell_samples.h"
#include "vps/errors.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

/// Least gap between points, divided by the spacing. Assumed: leaves a quarter of the spacing to the fill
/// pass.
constexpr double kMinGap = 0.75;
/// Candidates per square of spacing. Assumed: about five for each point that is kept; more change little.
constexpr double kCandidates = 6;
/// Greatest extent of a piece of surface that is assigned to a point, divided by the spacing. Assumed: about
/// 15 pieces a point.
constexpr double kAreaPiece = 0.3;

/// Height of a bump that gets points of its own, divided by the spacing. Assumed: 10 um at 1 mm, the depth
/// that a verdict counts as contact.
constexpr double kBump = 0.01;
/// Cosine of 20 degrees: normals that are farther apart belong to a tight curve. The normal of a contact that
/// moves along a face turns by no larger angle.
constexpr double kCosTight = 0.94;
/// Least length of the weighted sum of normals around a vertex, whose angles are a few radians.
constexpr double kLeastMean = 1e-3;

/// A convex piece of a triangle. Pieces are cut across the longest side of their box, so that slivers become
/// short pieces. (Cutting triangles at an edge keeps slivers slivers: 18 times as many pieces on a cylinder's
/// wall.)
class Piece {
 public:
  Piece(const Vec3& a, const Vec3& b, const Vec3& c) : corners_{a, b, c}, count_(3) {}

  /// The mean of the corners, which lies on the surface and inside the piece.
  [[nodiscard]] Vec3 center() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < count_; ++i) sum += corners_[i];
    return sum / count_;
  }
  /// Greatest distance of a corner from the centre.
  [[nodiscard]] double extent() const {
    const Vec3 m = center();
    double squared = 0;
    for (int i = 0; i < count_; ++i) squared = std::max(squared, (corners_[i] - m).squaredNorm());
    return std::sqrt(squared);
  }
  [[nodiscard]] double area() const {
    double sum = 0;
    for (int i = 2; i < count_; ++i) sum += fanArea(i);
    return sum;
  }
  /// Maps two uniform random numbers to a uniform point. Source: Turk 1990, on the triangle of the fan that u
  /// selects.
  [[nodiscard]] Vec3 pointAt(double u, double v) const {
    double share = u * area();
    int i = 2;
    for (; i + 1 < count_ && share > fanArea(i); ++i) share -= fanArea(i);
    const double s = std::sqrt(std::min(1.0, share / std::max(fanArea(i), 1e-300)));
    return (1 - s) * corners_[0] + s * ((1 - v) * corners_[i - 1] + v * corners_[i]);
  }
  [[nodiscard]] std::array<Piece, 2> halves() const {
    Box box;
    for (int i = 0; i < count_; ++i) box.add(corners_[i]);
    int axis = 0;
    box.size().maxCoeff(&axis);
    const double middle = box.center()[axis];
    std::array<Piece, 2> parts;
    for (int i = 0; i < count_; ++i) {
      const Vec3 &p = corners_[i], &q = corners_[(i + 1) % count_];
      const double from = p[axis] - middle, to = q[axis] - middle;
      if (from <= 0) parts[0].addCorner(p);
      if (from >= 0) parts[1].addCorner(p);
      if (from * to < 0) {
        const Vec3 cut = p + from / (from - to) * (q - p);
        parts[0].addCorner(cut);
        parts[1].addCorner(cut);
      }
    }
    return parts;
  }

 private:
  Piece() = default;
  friend struct std::array<Piece, 2>;
  void addCorner(const Vec3& p) {
    VPS_ASSERT(count_ < kMaxCorners);
    corners_[count_++] = p;
  }
  [[nodiscard]] double fanArea(int i) const {
    return 0.5 * (corners_[i - 1] - corners_[0]).cross(corners_[i] - corners_[0]).norm();
  }

  static constexpr int kMaxCorners = 12;  ///< a triangle cut by the six sides of a box has at most nine
  std::array<Vec3, kMaxCorners> corners_;
  int count_ = 0;
};

/// A random number of 53 bits in [0, 1) that depends on its index alone.
/// Source: the finaliser of SplitMix64 (Steele, Lea and Flood 2014).
double randomAt(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

class FaceSampler {
 public:
  FaceSampler(const Mesh& mesh, const std::vector<Vec3>& normals, double spacing_m,
              std::vector<ShellSample>& samples)
      : mesh_(mesh),
        normals_(normals),
        spacing_m_(spacing_m),
        samples_(samples),
        grid_(kCell * spacing_m, samples.size() + 1024) {
    for (std::size_t i = 0; i < samples_.size(); ++i)
      grid_.insert(samples_[i].p, static_cast<std::uint32_t>(i));
  }

  /// Tries some candidates in each block of the surface, and keeps those with no point too near. Proceeding
  /// block by block is as random as proceeding over the whole surface and ten times as fast, since near
  /// points are near in memory.
  void throwDarts() {
    const double darts_per_m2 = kCandidates / (spacing_m_ * spacing_m_);
    double owed = 0;  // fractions of darts left over from small triangles
    std::uint64_t index = 0;
    forEachBlock([&](const Piece& block, const Vec3& n) {
      for (owed += darts_per_m2 * block.area(); owed >= 1; --owed) {
        const Vec3 p = block.pointAt(randomAt(index), randomAt(index + 1));
        index += 2;
        if (nearest(p).distance_m > kMinGap * spacing_m_) add(p, n);
      }
    });
  }

  void fill() {
    forEachBlock([this](const Piece& block, const Vec3& n) { cover(block, n); });
  }

  /// Adds points on bumps. A bump smaller than the spacing may lie between all points, and a surface of
  /// triangles is highest at its vertices. Vertices that protrude get a point, the highest first, until no
  /// vertex protrudes.
  void addBumps() {
    struct Bump {
      double height_m;
      std::uint32_t vertex;
    };
    std::vector<Bump> bumps;
    const std::vector<Vec3> outward = vertexNormals();
    for (std::uint32_t v = 0; v < outward.size(); ++v) {
      if (outward[v].isZero(0)) continue;
      const double height_m = heightOf(mesh_.vertices[v], outward[v]);
      if (height_m > kBump * spacing_m_) bumps.push_back({height_m, v});
    }
    std::sort(bumps.begin(), bumps.end(), [](const Bump& a, const Bump& b) {
      return a.height_m != b.height_m ? a.height_m > b.height_m : a.vertex < b.vertex;
    });
    for (const Bump& bump : bumps) {
      const Vec3 &p = mesh_.vertices[bump.vertex], &n = outward[bump.vertex];
      if (heightOf(p, n) > kBump * spacing_m_) add(p, n);
    }
  }

  void dealOutArea() {
    forEachBlock([this](const Piece& block, const Vec3&) { dealOut(block); });
  }

 private:
  /// Edge of the grid's cells, in spacings.
  static constexpr double kCell = 2;

  /// A sample near a block of surface. Candidates are collected once and searched for each piece of the
  /// block.
  struct Candidate {
    Vec3 p;
    std::uint32_t id;
  };
  struct Near {
    std::uint32_t id = 0;
    double distance_m = std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] bool facesAs(std::uint32_t id, const Vec3& n) const {
    return samples_[id].outward.dot(n) > 0;
  }

  /// Collects the samples that face the same way as n and are within the spacing of any point of the block.
  void gather(const Piece& block, const Vec3& n) {
    candidates_.clear();
    grid_.visitNear(block.center(), block.extent() + spacing_m_, [&](std::uint32_t id, double) {
      if (facesAs(id, n)) candidates_.push_back({samples_[id].p, id});
      return true;
    });
  }

  /// The nearest of the collected samples.
  [[nodiscard]] Near nearest(const Vec3& p) const {
    Near near;
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate& c : candidates_) {
      const double squared = (c.p - p).squaredNorm();
      if (squared < least) {
        least = squared;
        near.id = c.id;
      }
    }
    near.distance_m = std::sqrt(least);
    return near;
  }

  void add(const Vec3& p, const Vec3& n) {
    const auto id = static_cast<std::uint32_t>(samples_.size());
    grid_.insert(p, id);
    candidates_.push_back({p, id});
    samples_.push_back({p, n, 0});
  }

  /// Mean unit normals of the vertices; zero at the edge of a blade. Sharp edges need no exception: their own
  /// points are nearer to their vertices than any other, and as high.
  [[nodiscard]] std::vector<Vec3> vertexNormals() const {
    std::vector<Vec3> mean = angleWeightedNormals(mesh_, normals_);
    for (Vec3& n : mean) n = n.norm() > kLeastMean ? n.normalized() : Vec3(Vec3::Zero());
    return mean;
  }

  /// How far a place on the surface protrudes beyond the nearest point, along the mean of both normals: zero
  /// on planes, cylinders, spheres and other surfaces that curve evenly between the two, convex or hollow.
  /// Where the surface curves so tightly that the normals are far apart, the height is measured along the
  /// place's own normal.
  [[nodiscard]] double heightOf(const Vec3& p, const Vec3& n) const {
    constexpr std::uint32_t kNone = 0xffffffff;
    std::uint32_t found = kNone;
    double least = 0;
    grid_.visitNear(p, spacing_m_, [&](std::uint32_t id, double squared) {
      const bool is_nearer = found == kNone || squared < least || (squared == least && id < found);
      if (is_nearer && facesAs(id, n)) {
        found = id;
        least = squared;
      }
      return true;
    });
    if (found == kNone) return 0;
    const ShellSample& sample = samples_[found];
    const Vec3 way = p - sample.p;
    const double height_m = (n + sample.outward).normalized().dot(way);
    return n.dot(sample.outward) < kCosTight ? std::max(height_m, n.dot(way)) : height_m;
  }

  /// Calls visit with each block of the surface after collecting its candidates.
  template <class Visit>
  void forEachBlock(const Visit& visit) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (normals_[t].isZero(0)) continue;
      const auto& [a, b, c] = mesh_.triangles[t];
      forEachBlock({mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]}, normals_[t], visit);
    }
  }

  /// Halves the piece until it is at most a spacing in extent.
  template <class Visit>
  void forEachBlock(const Piece& piece, const Vec3& n, const Visit& visit) {
    pollStop();
    if (piece.extent() <= spacing_m_) {
      gather(piece, n);
      visit(piece, n);
      return;
    }
    for (const Piece& half : piece.halves()) forEachBlock(half, n, visit);
  }

  /// Adds samples until every point of the piece has one within the spacing. A piece of extent e whose centre
  /// is d from a sample lies within d + e of it. If d + e is more than the spacing, either the centre is free
  /// for a new sample or the piece is halved; halving ends at e <= (1 - kMinGap) spacing at the latest.
  void cover(const Piece& piece, const Vec3& n) {
    pollStop();
    const double extent_m = piece.extent();
    const Vec3 center = piece.center();
    const double distance_m = nearest(center).distance_m;
    if (distance_m + extent_m <= spacing_m_) return;
    if (distance_m > kMinGap * spacing_m_) return add(center, n);
    for (const Piece& half : piece.halves()) cover(half, n);
  }

  void dealOut(const Piece& piece) {
    pollStop();
    if (piece.extent() > kAreaPiece * spacing_m_) {
      for (const Piece& half : piece.halves()) dealOut(half);
      return;
    }
    samples_[nearest(piece.center()).id].area_m2 += piece.area();
  }

  const Mesh& mesh_;
  const std::vector<Vec3>& normals_;
  double spacing_m_;
  std::vector<ShellSample>& samples_;
  PointGrid grid_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::vector<Vec3> triangleNormals(const Mesh& mesh) {
  std::vector<Vec3> normals;
  normals.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& p = mesh.vertices[a];
    normals.push_back(unitOrZero((mesh.vertices[b] - p).cross(mesh.vertices[c] - p)));
  }
  return normals;
}

void sampleFaces(const Mesh& mesh, const std::vector<Vec3>& normals, double spacing_m,
                 std::vector<ShellSample>& samples) {
  FaceSampler sampler(mesh, normals, spacing_m, samples);
  sampler.throwDarts();
  sampler.fill();
  sampler.addBumps();
  sampler.dealOutArea();
}

}  // namespace vps
