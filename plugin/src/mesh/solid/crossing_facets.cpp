// SPDX-License-Identifier: BSD-3-Clause
// Two triangles that cross do so along a segment. Its ends lie on an edge of one triangle and in the other.
// It is therefore enough to test edges against triangles.
#include "mesh/solid/interior.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "mesh/triangle_distance.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

/// Distance that counts as contact, relative to the greatest coordinate: about fifty times its rounding
/// error.
constexpr double kContact = 1e-14;

double greatestCoordinate(const Mesh& mesh) {
  const Box box = bounds(mesh);
  return box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
}

struct Triangle {
  Vec3 corner[3];
  Vec3 n;  // unit; zero for a triangle too thin to have a normal
};

double cross2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// True if segments ab and cd share a point. All four points lie in a plane.
bool meetInPlane(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                 const Eigen::Vector2d& d) {
  const double c_side = cross2(b - a, c - a), d_side = cross2(b - a, d - a);
  const double a_side = cross2(d - c, a - c), b_side = cross2(d - c, b - c);
  return c_side * d_side <= 0 && a_side * b_side <= 0 &&
         // Parallel segments: are they apart along their line?
         (c_side != 0 || d_side != 0 ||
          (std::min(a.x(), b.x()) <= std::max(c.x(), d.x()) &&
           std::min(c.x(), d.x()) <= std::max(a.x(), b.x()) &&
           std::min(a.y(), b.y()) <= std::max(c.y(), d.y()) &&
           std::min(c.y(), d.y()) <= std::max(a.y(), b.y())));
}

bool touches(const Triangle& t, const Vec3& p, double touch_m) {
  return (closestOnTriangleInline(p, t.corner[0], t.corner[1], t.corner[2]).q - p).squaredNorm() <=
         touch_m * touch_m;
}

/// True if segment ab shares a point with the triangle.
bool meets(const Triangle& t, const Vec3& a, const Vec3& b, double touch_m) {
  const double at_a = t.n.dot(a - t.corner[0]), at_b = t.n.dot(b - t.corner[0]);
  if (std::min(at_a, at_b) > touch_m || std::max(at_a, at_b) < -touch_m) return false;
  if (std::abs(at_a) > touch_m || std::abs(at_b) > touch_m)
    return touches(t, a + std::clamp(at_a / (at_a - at_b), 0.0, 1.0) * (b - a), touch_m);
  if (touches(t, a, touch_m) || touches(t, b, touch_m)) return true;
  int axis = 0;
  t.n.cwiseAbs().maxCoeff(&axis);
  const auto flat = [axis](const Vec3& p) { return Eigen::Vector2d(p[(axis + 1) % 3], p[(axis + 2) % 3]); };
  for (int k = 0; k < 3; ++k)
    if (meetInPlane(flat(a), flat(b), flat(t.corner[k]), flat(t.corner[(k + 1) % 3]))) return true;
  return false;
}

/// A facet whose box overlaps more boxes than this is not tested: the hub of a fan of 100,000 facets would
/// take 10^10 tests.
constexpr std::size_t kMostNear = 4096;

class Crossings {
 public:
  Crossings(const MeshDistance& all, std::size_t count)
      : all_(all), mesh_(all.mesh()), touch_m_(kContact * greatestCoordinate(mesh_)), found_(count) {}

  std::vector<Crossed> run() {
    constexpr std::size_t kGrain = 256;
    StoppableWork* const own = WorkOnThread::current();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found_.size(), kGrain), [&](const auto& range) {
      const WorkOnThread on_thread(own);
      std::vector<std::uint32_t> near;
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        pollStop(), test(static_cast<std::uint32_t>(i), near);
    });
    return {found_.begin(), found_.end()};
  }

 private:
  void test(std::uint32_t own, std::vector<std::uint32_t>& near) {
    Box box;
    for (const std::uint32_t v : mesh_.triangles[own]) box.add(mesh_.vertices[v]);
    const bool is_complete = all_.overlapping(box, kMostNear, near);
    for (const std::uint32_t other : near) {
      // Each pair is tested once; triangles from number `count` on are tested only as the second triangle of
      // a pair.
      if (other == own || (other < found_.size() && other < own) || !doMeet(own, other)) continue;
      found_[own].store(Crossed::Yes, std::memory_order_relaxed);
      if (other < found_.size()) found_[other].store(Crossed::Yes, std::memory_order_relaxed);
    }
    Crossed none = Crossed::No;
    if (!is_complete) found_[own].compare_exchange_strong(none, Crossed::Unknown);
  }

  [[nodiscard]] Triangle triangle(std::uint32_t i) const {
    const auto& t = mesh_.triangles[i];
    return {{mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]}, all_.featureNormal(i, 0)};
  }

  [[nodiscard]] bool doMeet(std::uint32_t i, std::uint32_t j) const {
    const auto &of_a = mesh_.triangles[i], &of_b = mesh_.triangles[j];
    int shared = 0, corner_a = 0, corner_b = 0;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        if (of_a[static_cast<std::size_t>(k)] == of_b[static_cast<std::size_t>(l)]) {
          ++shared;
          corner_a = k;
          corner_b = l;
        }
    if (shared == 3) return false;
    const Triangle a = triangle(i), b = triangle(j);
    if (shared == 2) return isFolded(a, b, of_a, of_b);
    if (shared == 1)
      return meets(a, b.corner[(corner_b + 1) % 3], b.corner[(corner_b + 2) % 3], touch_m_) ||
             meets(b, a.corner[(corner_a + 1) % 3], a.corner[(corner_a + 2) % 3], touch_m_);
    if (isBeside(a, b) || isBeside(b, a)) return false;
    for (int k = 0; k < 3; ++k)
      if (meets(a, b.corner[k], b.corner[(k + 1) % 3], touch_m_) ||
          meets(b, a.corner[k], a.corner[(k + 1) % 3], touch_m_))
        return true;
    return false;
  }

  /// True if b lies on one side of a's plane.
  [[nodiscard]] bool isBeside(const Triangle& a, const Triangle& b) const {
    const double at[3] = {a.n.dot(b.corner[0] - a.corner[0]), a.n.dot(b.corner[1] - a.corner[0]),
                          a.n.dot(b.corner[2] - a.corner[0])};
    return std::min({at[0], at[1], at[2]}) > touch_m_ || std::max({at[0], at[1], at[2]}) < -touch_m_;
  }

  /// True if two triangles with a common edge lie on each other: the free corner of one is in the other's
  /// plane, on the same side of the edge.
  [[nodiscard]] bool isFolded(const Triangle& a, const Triangle& b, const std::array<std::uint32_t, 3>& of_a,
                              const std::array<std::uint32_t, 3>& of_b) const {
    const auto freeCorner = [](const auto& own, const auto& other) {
      for (std::size_t k = 0; k < 3; ++k)
        if (std::find(other.begin(), other.end(), own[k]) == other.end()) return static_cast<int>(k);
      return 0;
    };
    const int k = freeCorner(of_a, of_b), l = freeCorner(of_b, of_a);
    const Vec3& foot = a.corner[(k + 1) % 3];
    const Vec3 inward = a.n.cross(a.corner[(k + 2) % 3] - foot);
    return std::abs(a.n.dot(b.corner[l] - foot)) <= touch_m_ && inward.dot(b.corner[l] - foot) > 0;
  }

  const MeshDistance& all_;
  const Mesh& mesh_;
  const double touch_m_;
  std::vector<std::atomic<Crossed>> found_;
};

}  // namespace

std::vector<Crossed> crossedFacets(const MeshDistance& all, std::size_t count) {
  return Crossings(all, count).run();
}

}  // namespace vps
