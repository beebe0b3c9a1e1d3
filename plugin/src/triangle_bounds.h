// SPDX-License-Identifier: BSD-3-Clause
// Quick lower bounds of the distance to many triangles: which of them are worth an exact answer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// Corners of a triangle, and a rectangle around it in its plane, whose distance is the bound: tight for
/// slivers too, which spheres and axis-aligned boxes are not.
struct BoundedTriangle {
  Vec3 a, b, c;
  Vec3 center, u, v, n;  // of the rectangle; u along the triangle's longest edge
  double half_u, half_v;

  BoundedTriangle(const Mesh& mesh, const std::array<std::uint32_t, 3>& t)
      : a(mesh.vertices[t[0]]), b(mesh.vertices[t[1]]), c(mesh.vertices[t[2]]) {
    Vec3 longest = b - a, other = c - a;
    if ((c - b).squaredNorm() > longest.squaredNorm()) longest = c - b, other = a - b;
    if ((a - c).squaredNorm() > longest.squaredNorm()) longest = a - c, other = b - c;
    u = longest.normalized();
    const Vec3 across = other - other.dot(u) * u;
    const double height = across.norm();
    // Collinear corners: any direction across will do, the rectangle has no width.
    v = height > 1e-12 * longest.norm() ? Vec3(across / height) : Vec3(u.unitOrthogonal());
    n = u.cross(v);
    Box in_uv;
    for (const Vec3& p : {a, b, c}) in_uv.add(Vec3((p - a).dot(u), (p - a).dot(v), 0));
    center = a + in_uv.center().x() * u + in_uv.center().y() * v;
    half_u = 0.5 * in_uv.size().x();
    half_v = 0.5 * in_uv.size().y();
  }

  /// Not more than the squared distance from p, but for rounding.
  [[nodiscard]] double bound2(const Vec3& p) const noexcept {
    const Vec3 r = p - center;
    const double du = std::max(std::abs(r.dot(u)) - half_u, 0.0);
    const double dv = std::max(std::abs(r.dot(v)) - half_v, 0.0);
    const double dn = r.dot(n);
    return du * du + dv * dv + dn * dn;
  }
};

/// The rectangles of a list of triangles in units and from an origin of the caller's, where float is fine
/// enough: what rounding may add to a bound is in slack(). Stored by component, so that the compiler takes
/// several at a time.
class TriangleBounds {
 public:
  [[nodiscard]] std::size_t size() const { return triangles_.size(); }
  [[nodiscard]] std::uint32_t triangle(std::size_t i) const { return triangles_[i]; }
  /// Most by which rounding can lift the root of a bound.
  [[nodiscard]] float slack() const { return slack_; }

  /// Empties the list and makes room.
  void reset(std::size_t capacity, float slack) {
    triangles_.clear();
    slack_ = slack;
    if (capacity <= capacity_) return;
    capacity_ = capacity + capacity / 2;
    values_.resize(kComponents * capacity_);
    bounds2_.resize(capacity_);
  }

  /// @param reach  greatest coordinate that bounds will be asked for
  void add(std::uint32_t index, const BoundedTriangle& t, const Vec3& origin, double per_unit, double reach) {
    const Vec3 center = (t.center - origin) * per_unit;
    const double half_u = t.half_u * per_unit, half_v = t.half_v * per_unit;
    const std::array<double, kComponents> values = {center.x(), center.y(), center.z(), t.u.x(), t.u.y(),
                                                    t.u.z(),    t.v.x(),    t.v.y(),    t.v.z(), t.n.x(),
                                                    t.n.y(),    t.n.z(),    half_u,     half_v};
    for (std::size_t k = 0; k < kComponents; ++k)
      values_[k * capacity_ + size()] = static_cast<float>(values[k]);
    triangles_.push_back(index);
    // About a dozen roundings (2^-24 each) of numbers this large at most.
    slack_ = std::max(slack_, 1e-6f * static_cast<float>(center.norm() + half_u + half_v + reach));
  }

  /// Appends entry i of another list.
  void addFrom(const TriangleBounds& from, std::size_t i) {
    for (std::size_t k = 0; k < kComponents; ++k)
      values_[k * capacity_ + size()] = from.values_[k * from.capacity_ + i];
    triangles_.push_back(from.triangles_[i]);
  }

  /// Squared bounds from p to every triangle of the list, for bounds2(). Returns which is least.
  std::size_t ask(const Eigen::Vector3f& p) {
    compute(p.x(), p.y(), p.z(), values_.data(), capacity_, size(), bounds2_.data());
    if (size() == 0) return 0;
    const float least =
        Eigen::Map<const Eigen::ArrayXf>(bounds2_.data(), static_cast<Eigen::Index>(size())).minCoeff();
    return static_cast<std::size_t>(std::find(bounds2_.begin(), bounds2_.end(), least) - bounds2_.begin());
  }
  [[nodiscard]] std::span<const float> bounds2() const { return {bounds2_.data(), size()}; }

 private:
  static constexpr std::size_t kComponents = 14;

  /// Components lie `stride` apart.
  static void compute(float px, float py, float pz, const float* __restrict v, std::size_t stride,
                      std::size_t count, float* __restrict out) {
    const float *cx = v, *cy = v + stride, *cz = v + 2 * stride;
    const float *ux = v + 3 * stride, *uy = v + 4 * stride, *uz = v + 5 * stride;
    const float *vx = v + 6 * stride, *vy = v + 7 * stride, *vz = v + 8 * stride;
    const float *nx = v + 9 * stride, *ny = v + 10 * stride, *nz = v + 11 * stride;
    const float *half_u = v + 12 * stride, *half_v = v + 13 * stride;
    for (std::size_t i = 0; i < count; ++i) {
      const float x = px - cx[i], y = py - cy[i], z = pz - cz[i];
      const float du = std::abs(x * ux[i] + y * uy[i] + z * uz[i]) - half_u[i];
      const float dv = std::abs(x * vx[i] + y * vy[i] + z * vz[i]) - half_v[i];
      const float dn = x * nx[i] + y * ny[i] + z * nz[i];
      // max(d, 0) as (d + |d|) / 2: a choice here keeps compilers from using vector instructions.
      const float past_u = 0.5f * (du + std::abs(du)), past_v = 0.5f * (dv + std::abs(dv));
      out[i] = past_u * past_u + past_v * past_v + dn * dn;
    }
  }

  std::vector<std::uint32_t> triangles_;
  std::vector<float> values_, bounds2_;
  std::size_t capacity_ = 0;
  float slack_ = 0;
};

}  // namespace vps
