// SPDX-License-Identifier: BSD-3-Clause
// One depth-first walk over the shell's spheres; whole clusters are skipped where the field proves that none
// of their points can matter. The proof must hold for the field as it is read, not for the true distance,
// because the answer promised is that of reading it at every point.
#include "vps/query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxmap_sampling.h"

namespace vps {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSqrt3 = 1.7320508075688772;

/// Bounds the field over spheres. Let f be the true signed distance, I the field: nodal values of f,
/// saturated at
/// +-band, trilinear between nodes. f changes by at most the way gone; so
///   (a) each component of I's gradient averages differences of neighbouring nodes over h and is at most 1:
///       |grad I| <= sqrt 3;
///   (b) |I(p) - f(p)| <= sum w_i |x_i - p| <= h sqrt(sum over axes of t (1 - t)) <= sqrt(3)/2 h, where
///   unsaturated,
///       by Jensen's inequality; and f >= x <= band at p gives I(p) >= x - sqrt(3)/2 h even where some nodes
///       saturate;
///   (c) I(p) = band where f(p) >= band + sqrt(3) h, since all eight nodes are nearer than sqrt(3) h.
/// (a) serves small spheres, (b) large ones, (c) far ones. Needs a field with consistent signs: a closed
/// mesh.
class SphereBound {
 public:
  explicit SphereBound(const VoxMap& map) noexcept
      : sampler_(map),
        band_m_(map.band_m()),
        diagonal_m_(kSqrt3 * map.voxel_m()),
        quantum_m_(1e-3 * map.voxel_m()) {}

  /// A value that the field is not below at any point of the sphere.
  [[nodiscard]] double least(const Vec3& center_M, double radius_m) const noexcept {
    const VoxSampler::Place at = sampler_.place(center_M);
    const double true_m = sampler_.leastDistance(center_M, at) - radius_m;
    if (true_m >= band_m_ + diagonal_m_) return band_m_;                       // (c)
    const double by_distance_m = std::min(true_m, band_m_) - diagonal_m_ / 2;  // (b)
    const double by_slope_m = sampler_.distance(at) - kSqrt3 * radius_m;       // (a)
    return std::max(by_distance_m, by_slope_m) - quantum_m_;
  }

  [[nodiscard]] const VoxSampler& sampler() const noexcept { return sampler_; }

 private:
  VoxSampler sampler_;
  double band_m_, diagonal_m_;
  double quantum_m_;  ///< allows for nodes stored with fewer digits (float now) and for rounding here
};

/// Least over the shell of a lower bound of the true distance, for shells that are all beyond the band:
/// spheres are opened until they are small beside their distance, since a quarter is precise enough to go by.
double farBound(const VoxSampler& sampler, const PointShell& shell, const Pose& X_MP) noexcept {
  constexpr double kSmall = 0.25;  // assumed
  const auto least = [&](const Vec3& p_P) {
    const Vec3 p_M = X_MP * p_P;
    return sampler.leastDistance(p_M, sampler.place(p_M));
  };
  double least_m = kInfinity;
  for (std::size_t i = 0; i < shell.nodes.size();) {
    const ShellNode& node = shell.nodes[i];
    const double center_m = least(node.center);
    const bool is_worse = center_m - node.radius_m >= least_m;
    if (is_worse || node.radius_m <= kSmall * center_m) {
      least_m = std::min(least_m, center_m - node.radius_m);
      i = node.skip;
      continue;
    }
    ++i;
    if (!node.is_leaf) continue;
    for (std::uint32_t id = node.first; id < node.first + node.count; ++id)
      least_m = std::min(least_m, least(shell.points[id]));
  }
  return least_m;
}

}  // namespace

QueryResult queryContacts(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                          const QueryOptions& options, ContactSet& out) noexcept {
  out.contacts.clear();
  out.left_out = 0;
  QueryResult result;
  if (!X_MP.isFinite()) {
    result.status = Status::BadPose;
    return result;
  }
  const SphereBound bound(map);
  const VoxSampler& sampler = bound.sampler();
  // A saturated reading says only "far": it is never a contact, however wide the cutoff.
  const double cutoff_m = std::min(options.cutoff_m, map.band_m() - 0.01 * map.voxel_m());
  double least_read_m = kInfinity, least_skipped_m = kInfinity;

  for (std::size_t i = 0; i < shell.nodes.size();) {
    const ShellNode& node = shell.nodes[i];
    if (!options.is_exhaustive) {
      const double node_m = bound.least(X_MP * node.center, node.radius_m);
      if (node_m > cutoff_m) {
        least_skipped_m = std::min(least_skipped_m, node_m);
        i = node.skip;
        continue;
      }
    }
    ++i;
    if (!node.is_leaf) continue;
    result.points_tested += node.count;
    for (std::uint32_t id = node.first; id < node.first + node.count; ++id) {
      const Vec3 p_M = X_MP * shell.points[id];
      const VoxSampler::Place at = sampler.place(p_M);
      const double distance_m = sampler.distance(at);
      least_read_m = std::min(least_read_m, distance_m);
      if (!(distance_m <= cutoff_m)) continue;
      if (out.contacts.size() == out.contacts.capacity()) {
        ++out.left_out;
        continue;
      }
      Vec3 n_M = sampler.normal(at, options.gradient);
      // Deeper than the band the field knows no way out; the point's own inward normal is the older VPS's
      // answer.
      if (n_M.isZero(0)) n_M = X_MP.R * shell.inward[id];
      out.contacts.push_back({p_M, n_M, distance_m, shell.area_m2[id], id, sampler.owner(at)});
    }
  }
  if (out.left_out > 0) result.status = Status::Truncated;
  result.min_distance_m = std::min(least_read_m, least_skipped_m);
  result.is_beyond_band = least_skipped_m < least_read_m || !(least_read_m < map.band_m());
  return result;
}

QueryResult queryDistance(const VoxMap& map, const PointShell& shell, const Pose& X_MP) noexcept {
  QueryResult result;
  if (!X_MP.isFinite()) {
    result.status = Status::BadPose;
    return result;
  }
  const SphereBound bound(map);
  const VoxSampler& sampler = bound.sampler();
  double least_m = map.band_m();
  const auto read = [&](std::uint32_t id) {
    ++result.points_tested;
    least_m = std::min(least_m, sampler.distance(sampler.place(X_MP * shell.points[id])));
  };
  // A few points from all over the shell first: the sooner something near is known, the more is skipped.
  constexpr std::size_t kSeeds = 32;
  for (std::size_t k = 0; k < std::min(kSeeds, shell.order.size()); ++k) read(shell.order[k]);
  // Once a point reads -band nothing can read less.
  for (std::size_t i = 0; i < shell.nodes.size() && least_m > -map.band_m();) {
    const ShellNode& node = shell.nodes[i];
    if (bound.least(X_MP * node.center, node.radius_m) >= least_m) {
      i = node.skip;
      continue;
    }
    ++i;
    if (!node.is_leaf) continue;
    for (std::uint32_t id = node.first; id < node.first + node.count; ++id) read(id);
  }
  result.min_distance_m = least_m;
  result.is_beyond_band = !(least_m < map.band_m());
  if (result.is_beyond_band) {
    result.status = Status::BeyondBand;
    // Saturated readings allow for a true distance that is half a cell's diagonal less, see (b).
    result.min_distance_m =
        std::max(farBound(sampler, shell, X_MP), map.band_m() - kSqrt3 / 2 * map.voxel_m());
  }
  return result;
}

Wrench penaltyWrench(std::span<const Contact> contacts, double k_N_per_m3, const Vec3& p_MO) noexcept {
  Wrench F_O_M;
  for (const Contact& c :
       contacts) {  // in the order of ids: a sum that depends on anything else breaks replay
    if (!(c.distance_m < 0)) continue;
    const Vec3 f_M = k_N_per_m3 * c.area_m2 * -c.distance_m * c.n_M;
    F_O_M.f += f_M;
    F_O_M.tau += (c.p_M - p_MO).cross(f_M);
  }
  return F_O_M;
}

}  // namespace vps
