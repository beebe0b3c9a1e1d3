// SPDX-License-Identifier: BSD-3-Clause
#include "vps/winding_number.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vps {
namespace {

constexpr std::uint32_t kLeafTriangles = 8;

using Corners = std::array<Vec3, 3>;

/// The distance beyond which a cluster's series has an error of at most `error`. The term of degree l of 1 /
/// |d - s| is s^l P_l / R^(l + 1); its slope in s is at most l s^(l - 1) / R^(l + 1) (inequality of Bernstein
/// and Szegö for the trigonometric polynomial P_l(cos)). The terms after degree 3 sum to
///   integral s^3 dA / (4 pi R^5) * (4 - 3t) / (1 - t)^2,   t = radius / R.
double acceptDistance(double radius, double third_moment, double error) {
  if (!(radius > 0)) return 0;
  const auto bound = [&](double R) {
    const double t = radius / R;
    return third_moment / (4 * std::numbers::pi * R * R * R * R * R) * (4 - 3 * t) / ((1 - t) * (1 - t));
  };
  double low = radius, high = 2 * radius;
  while (bound(high) > error) high *= 2;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (bound(middle) > error ? low : high) = middle;
  }
  return high;
}

/// The longest edge, from corner .first to the next.
std::pair<int, double> longestEdge(const Corners& t) {
  std::pair<int, double> longest = {0, 0};
  for (int i = 0; i < 3; ++i) {
    const double length = (t[(i + 1) % 3] - t[i]).norm();
    if (length > longest.second) longest = {i, length};
  }
  return longest;
}

void halve(const Corners& t, double limit, std::vector<Corners>& out) {
  const auto [i, length] = longestEdge(t);
  if (!(length > limit)) {
    out.push_back(t);
    return;
  }
  const Vec3 middle = 0.5 * (t[i] + t[(i + 1) % 3]);
  halve({t[i], middle, t[(i + 2) % 3]}, limit, out);
  halve({middle, t[(i + 1) % 3], t[(i + 2) % 3]}, limit, out);
}

/// Cuts long triangles: a cluster is at least as wide as its longest triangle, and CAD exports make rods of
/// slivers, for which no point would be far. The limit is the least that at most triples the number of
/// triangles.
void cutSlivers(std::vector<Corners>& triangles) {
  std::vector<std::array<double, 2>> sides(triangles.size());  // the longest edge, and the height on it
  double low = 0, high = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Corners& t = triangles[i];
    const double length = longestEdge(t).second;
    sides[i] = {length, length > 0 ? (t[1] - t[0]).cross(t[2] - t[0]).norm() / length : 0};
    high = std::max(high, length);
  }
  for (int n = 0; n < 30; ++n) {
    const double middle = 0.5 * (low + high);
    double pieces = 0;
    // Repeated halving makes up to twice as many pieces in each direction as the limit requires.
    for (const auto& [length, height] : sides)
      pieces += length <= middle ? 1 : (1 + 2 * length / middle) * (1 + 2 * height / middle);
    (pieces <= 3.0 * static_cast<double>(sides.size()) ? high : low) = middle;
  }
  if (!(high > 0)) return;
  std::vector<Corners> cut;
  cut.reserve(3 * triangles.size());
  StridedPoll poll;
  for (const Corners& t : triangles) poll(), halve(t, high, cut);
  triangles = std::move(cut);
}

}  // namespace

/// Integrals over a cluster of the normal n and the position s from a centre: n_i, s_i n_j, s_i s_j n_k.
struct WindingNumber::Moments {
  Vec3 center = Vec3::Zero();
  Vec3 n = Vec3::Zero();
  Mat3 sn = Mat3::Zero();
  std::array<Mat3, 3> ssn = {Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};  // [k](i, j)
  Vec3 place = Vec3::Zero();                                             // integral of |n| times place
  double area = 0;

  void add(const Corners& t) {
    const Vec3 a = t[0] - center, b = t[1] - center, c = t[2] - center;
    const Vec3 n_t = 0.5 * (b - a).cross(c - a), s = (a + b + c) / 3;
    const Mat3 ss = (a * a.transpose() + b * b.transpose() + c * c.transpose() + 9 * s * s.transpose()) / 12;
    n += n_t;
    sn += s * n_t.transpose();
    for (int k = 0; k < 3; ++k) ssn[k] += n_t[k] * ss;
  }
  void addArea(const Corners& t) {
    const double area_t = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    area += area_t;
    place += area_t * (t[0] + t[1] + t[2]) / 3;
  }
  /// Adds another cluster's moments, moved to this cluster's centre: s becomes s + t.
  void add(const Moments& o) {
    const Vec3 t = o.center - center;
    n += o.n;
    sn += o.sn + t * o.n.transpose();
    for (int k = 0; k < 3; ++k)
      ssn[k] +=
          o.ssn[k] + t * o.sn.col(k).transpose() + o.sn.col(k) * t.transpose() + o.n[k] * t * t.transpose();
  }

  /// Coefficients of the three polynomials, x < y < z.
  [[nodiscard]] std::array<double, 19> series() const {
    const double trace = sn.trace();
    Vec3 v;  // the vector that makes the cubic polynomial harmonic
    for (int k = 0; k < 3; ++k) {
      v[k] = ssn[k].trace();
      for (int i = 0; i < 3; ++i) v[k] += 2 * ssn[i](k, i);
    }
    // The coefficient of d_i^2 d_j, and of x y z.
    const auto square = [&](int i, int j) {
      return 7.5 * (ssn[j](i, i) + (i == j ? 0 : 2 * ssn[i](i, j))) - 1.5 * v[j];
    };
    std::array<double, 19> c = {n.x(),
                                n.y(),
                                n.z(),
                                3 * sn(0, 0) - trace,
                                3 * sn(1, 1) - trace,
                                3 * sn(2, 2) - trace,
                                3 * (sn(0, 1) + sn(1, 0)),
                                3 * (sn(0, 2) + sn(2, 0)),
                                3 * (sn(1, 2) + sn(2, 1)),
                                square(0, 0),
                                square(0, 1),
                                square(0, 2),
                                square(1, 1),
                                square(1, 0),
                                square(1, 2),
                                square(2, 2),
                                square(2, 0),
                                square(2, 1),
                                15 * (ssn[2](0, 1) + ssn[1](0, 2) + ssn[0](1, 2))};
    for (double& value : c) value /= -4 * std::numbers::pi;
    return c;
  }
};

/// Adds solid angles by multiplying complex numbers whose arguments are half the angles, and counts full
/// turns: one arc tangent at the end instead of one per triangle.
struct WindingNumber::Turn {
  double x = 1, y = 0;
  int turns = 0;

  void add(const Corners& t, const Vec3& p) {
    const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double im = a.dot(b.cross(c));
    const double re = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    const double px = x * re - y * im, py = x * im + y * re;
    const double size = std::abs(px) + std::abs(py);
    if (!(size > 0)) return;  // the point is a corner, or on an edge: the triangle is seen from its own plane
    if (y >= 0 && im >= 0 && py < 0) ++turns;
    if (y < 0 && im < 0 && py >= 0) --turns;
    x = px / size;
    y = py / size;
  }
  /// Solid angle over 4 pi; the argument is half of it.
  [[nodiscard]] double windings() const { return std::atan2(y, x) / (2 * std::numbers::pi) + turns; }
};

WindingNumber::WindingNumber(const Mesh& mesh, double cluster_error) {
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  build(std::move(triangles), cluster_error);
}

WindingNumber::WindingNumber(const Mesh& mesh, std::span<const std::uint32_t> triangles,
                             double cluster_error) {
  std::vector<Corners> chosen;
  chosen.reserve(triangles.size());
  for (const std::uint32_t i : triangles) {
    const auto& t = mesh.triangles[i];
    chosen.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  }
  build(std::move(chosen), cluster_error);
}

void WindingNumber::build(std::vector<Corners> triangles, double cluster_error) {
  cluster_error_ = cluster_error;
  if (triangles.empty()) return;
  Box box;
  for (const Corners& t : triangles)
    for (const Vec3& p : t) box.add(p);
  origin_ = box.center();
  const double size = box.size().maxCoeff();
  // Sizes outside 1e-300 to 1e300 are not scaled, so that the scale is a finite number.
  scale_ = size > 1e-300 && size < 1e300 ? std::exp2(-std::ceil(std::log2(size))) : 1;
  for (Corners& t : triangles)
    for (Vec3& p : t) p = scale_ * (p - origin_);
  cutSlivers(triangles);
  std::vector<Vec3> middles;  // three times
  middles.reserve(triangles.size());
  for (const Corners& t : triangles) middles.emplace_back(t[0] + t[1] + t[2]);
  const Hierarchy tree = buildHierarchy(triangles.size(), [&](std::span<std::uint32_t> items) -> std::size_t {
    if (items.size() <= kLeafTriangles) return 0;
    divideByPoint(items, items.size() / 2, middles);
    return items.size() / 2;
  });
  corners_.reserve(triangles.size());
  for (const std::uint32_t i : tree.order) corners_.push_back(triangles[i]);
  copyLinks(tree, nodes_);
  expand();
}

/// Computes the moments from the leaves up, and from the moments each node's series and reach.
void WindingNumber::expand() {
  std::vector<Moments> moments(nodes_.size());
  StridedPoll poll;
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    poll();
    Node& node = nodes_[n];
    Moments& m = moments[n];
    const std::span<const Corners> triangles = std::span(corners_).subspan(node.first, node.end - node.first);
    if (node.isLeaf()) {
      for (const Corners& t : triangles) m.addArea(t);
    } else {
      for (const std::size_t child : {n + 1, std::size_t{node.right}}) {
        m.area += moments[child].area;
        m.place += moments[child].place;
      }
    }
    // The centroid of the area: the second term of flat clusters is then zero.
    m.center = node.center = m.area > 0 ? Vec3(m.place / m.area) : triangles[0][0];
    if (node.isLeaf()) {
      for (const Corners& t : triangles) m.add(t);
    } else {
      m.add(moments[n + 1]);
      m.add(moments[node.right]);
    }
    node.series = m.series();
    double radius2 = 0, third = 0;
    for (const Corners& t : triangles) {
      double cubes = 0;  // s^3 is convex: its mean over a triangle is at most that over the corners
      for (const Vec3& p : t) {
        const double s2 = (p - node.center).squaredNorm();
        radius2 = std::max(radius2, s2);
        cubes += s2 * std::sqrt(s2);
      }
      third += cubes / 6 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    }
    const double accept = acceptDistance(std::sqrt(radius2), third, cluster_error_);
    node.accept2 = accept * accept;
  }
}

WindingNumber::Value WindingNumber::at(const Vec3& p) const noexcept {
  if (nodes_.empty()) return {};
  const Vec3 x = scale_ * (p - origin_);
  double far = 0;
  int clusters = 0;
  Turn near;
  for (std::size_t n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    const Vec3 d = x - node.center;
    const double R2 = d.squaredNorm();
    if (!(R2 > node.accept2)) {
      if (node.isLeaf())
        for (std::uint32_t i = node.first; i < node.end; ++i) near.add(corners_[i], x);
      ++n;
      continue;
    }
    const double per_R2 = 1 / R2, per_R = std::sqrt(per_R2);
    const double X = d.x(), Y = d.y(), Z = d.z(), XX = X * X, YY = Y * Y, ZZ = Z * Z;
    const auto& c = node.series;
    const double first = c[0] * X + c[1] * Y + c[2] * Z;
    const double second = c[3] * XX + c[4] * YY + c[5] * ZZ + X * (c[6] * Y + c[7] * Z) + c[8] * Y * Z;
    const double third = XX * (c[9] * X + c[10] * Y + c[11] * Z) + YY * (c[12] * Y + c[13] * X + c[14] * Z) +
                         ZZ * (c[15] * Z + c[16] * X + c[17] * Y) + c[18] * X * Y * Z;
    far += (first + (second + third * per_R2) * per_R2) * per_R2 * per_R;
    ++clusters;
    n = node.skip;
  }
  return {near.windings() + far, clusters * cluster_error_};
}

double WindingNumber::exact(const Vec3& p) const noexcept {
  Turn all;
  const Vec3 x = scale_ * (p - origin_);
  for (const Corners& t : corners_) all.add(t, x);
  return all.windings();
}

}  // namespace vps
