// SPDX-License-Identifier: BSD-3-Clause
#include "vps/winding_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/analytic.h"
#include "support/no_alloc.h"

namespace vps::test {
namespace {

/// One arc tangent per triangle, as in van Oosterom and Strackee 1983: a reference for the exact sum.
double byArcTangents(const Mesh& mesh, const Vec3& p) {
  double angle_sr = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle_sr +=
        2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle_sr / (4 * std::numbers::pi);
}

/// Keeps only every k-th triangle, so that there are holes everywhere.
Mesh riddled(Mesh mesh, std::size_t k) {
  std::size_t i = 0;
  std::erase_if(mesh.triangles, [&](const auto&) { return i++ % k == 0; });
  return mesh;
}

TEST(WindingNumber, ClosedMeshesWindOnceInsideAndNeverOutside) {
  const Vec3 half(0.01, 0.02, 0.015);
  const WindingNumber w(makeBox(2 * half));
  RandomPoints random(1);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = random.inBox(2 * half);
    const double d = boxDistance(p, half);
    if (std::abs(d) < 1e-9) continue;
    const WindingNumber::Value value = w.at(p);
    ASSERT_NEAR(value.w, d < 0 ? 1 : 0, value.error + 1e-12);
    ASSERT_NEAR(w.exact(p), d < 0 ? 1 : 0, 1e-12);  // sums of 12 angles
  }
}

TEST(WindingNumber, ADiscHasItsSolidAngle) {
  // The solid angle of a disc of radius r from height z is 2 pi (1 - z / sqrt(z^2 + r^2)), negative in front
  // of it. A polygon of n corners has the disc's area to within 2 pi^2 / 3 n^2.
  constexpr int kSegments = 2000;
  Mesh disc;
  disc.vertices.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kSegments;
    disc.vertices.emplace_back(std::cos(angle_rad), std::sin(angle_rad), 0);
    disc.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSegments});
  }
  const WindingNumber w(disc);
  for (const double z : {1e-3, 0.1, 1.0, 10.0}) {
    const double truth = 0.5 * (1 - z / std::hypot(z, 1));
    EXPECT_NEAR(w.at({0, 0, -z}).w, truth, 2e-6 + w.at({0, 0, -z}).error) << z;
    EXPECT_NEAR(w.exact({0, 0, -z}), truth, 2e-6) << z;
    EXPECT_NEAR(w.exact({0, 0, z}), -truth, 2e-6) << z;
  }
}

TEST(WindingNumber, OneArcTangentGivesTheSumOfMany) {
  const Mesh mesh = riddled(transformed(makeTube(0.01, 0.006, 0.02, 100), RandomPoints(2).pose(0.01)), 3);
  const WindingNumber w(mesh);
  RandomPoints random(3);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random.inBox(Vec3::Constant(0.02));
    ASSERT_NEAR(w.exact(p), byArcTangents(mesh, p), 1e-13 * static_cast<double>(mesh.triangles.size()));
  }
}

TEST(WindingNumber, MultiplyCoveredPointsAreCounted) {
  Mesh nested;
  for (int i = 1; i <= 6; ++i) append(nested, makeSphere(0.01 * i, 3));
  EXPECT_NEAR(WindingNumber(nested).exact({0, 0, 0}), 6, 1e-9);
  EXPECT_NEAR(WindingNumber(nested).at({0.025, 0, 0}).w, 4, WindingNumber(nested).at({0.025, 0, 0}).error);
  for (auto& t : nested.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(WindingNumber(nested).exact({0, 0, 0}), -6, 1e-9);
}

TEST(WindingNumber, ClustersStayWithinTheirErrorBound) {
  RandomPoints random(4);
  for (const double cluster_error : {1e-2, 1e-3, 1e-5, 1e-7}) {
    const Mesh mesh = riddled(makeSphere(0.01, 5), 7);
    const WindingNumber w(mesh, cluster_error);
    double worst = 0;
    for (int n = 0; n < 300; ++n) {
      const Vec3 p = random.inBox(Vec3::Constant(n % 2 ? 0.012 : 0.05));
      const WindingNumber::Value value = w.at(p);
      const double error = std::abs(value.w - w.exact(p));
      ASSERT_LE(error, value.error + 1e-11);
      worst = std::max(worst, error);
    }
    RecordProperty("worst_over_cluster_error", std::to_string(worst / cluster_error));
    EXPECT_LT(worst, 10 * cluster_error);  // measured, 5 at most: errors of both signs cancel
  }
}

TEST(WindingNumber, UnitAndPositionDoNotMatter) {
  const Mesh mesh = riddled(makeSphere(1, 3), 5);
  const WindingNumber w(mesh);
  RandomPoints random(5);
  for (const double scale : {1e-12, 1e-6, 1e6}) {
    Mesh other = mesh;
    for (Vec3& p : other.vertices) p *= scale;
    const WindingNumber w_scaled(other);
    for (int n = 0; n < 200; ++n) {
      const Vec3 p = random.inBox(Vec3::Constant(1.5));
      ASSERT_NEAR(w_scaled.at(scale * p).w, w.at(p).w, w.at(p).error + 1e-9);
    }
  }
}

TEST(WindingNumber, PointsOnTheMeshGiveAFiniteNumber) {
  const Mesh mesh = makeBox({1, 1, 1});
  const WindingNumber w(mesh);
  for (const Vec3& p : mesh.vertices) EXPECT_TRUE(std::isfinite(w.at(p).w));
  EXPECT_TRUE(std::isfinite(w.at({0.5, 0.1, 0.1}).w));
  EXPECT_TRUE(std::isfinite(w.at({0.5, 0.5, 0.1}).w));
  EXPECT_EQ(WindingNumber(Mesh{}).at({0, 0, 0}).w, 0);
  Mesh point;
  point.vertices.assign(3, Vec3(1, 2, 3));
  point.triangles = {{0, 1, 2}};
  EXPECT_EQ(WindingNumber(point).at({1, 2, 3}).w, 0);
  EXPECT_EQ(WindingNumber(point).at({0, 0, 0}).w, 0);
}

TEST(WindingNumber, AQueryAllocatesNothing) {
  const WindingNumber w(makeSphere(1, 4));
  const vps_test::NoAllocScope guard;
  double sum = 0;
  for (int n = 0; n < 100; ++n) sum += w.at({0.01 * n, 0.3, 0.2}).w;
  EXPECT_GT(sum, 0);
}

}  // namespace
}  // namespace vps::test
