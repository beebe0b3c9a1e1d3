// SPDX-License-Identifier: BSD-3-Clause
// Small assemblies with a known order, for tests of planning. All of them are unions of convex prisms.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/scene_part.h"
#include "support/lathe.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {

inline DrawnPart at(const std::string& name, const Mesh& mesh, const Vec3& p_W) {
  return {name, mesh, Pose::translation(p_W), {}, false};
}

inline Scene sceneOf(const std::vector<DrawnPart>& parts) {
  Scene scene;
  scene.name = "test";
  for (const DrawnPart& part : parts) {
    scene.parts.push_back(scenePart(part.name, part.mesh, Vec3::Zero(), false));
    scene.parts.back().X_WP = part.X_WP;
  }
  return scene;
}

/// Checks that no path of the plan leads through a part, by a measure that is independent of the search.
inline void expectFreeWays(const std::vector<DrawnPart>& parts, const PlanResult& plan) {
  for (const Scene& scene : plannedScenes(sceneOf(parts), plan))
    for (const WayFault& fault : checkWays(scene))
      ADD_FAILURE() << fault.part << " through " << fault.against << " by " << fault.depth_m << " at "
                    << fault.at_W.transpose();
}

inline Mesh block(const Vec3& min, const Vec3& max) {
  return transformed(makeBox(max - min), Pose::translation(0.5 * (min + max)));
}

/// A prism: a convex polygon of (x, z), counter-clockwise as seen from -y, extruded along y from -half to
/// half.
inline Mesh prismAlongY(const std::vector<std::array<double, 2>>& polygon, double half_m) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double y : {-half_m, half_m})
    for (const auto& [x, z] : polygon) mesh.vertices.emplace_back(x, y, z);
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({0, i, i + 1});
    mesh.triangles.push_back({n, n + i + 1, n + i});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n;
    mesh.triangles.push_back({i, n + i, n + k});
    mesh.triangles.push_back({i, n + k, k});
  }
  return mesh;
}

/// A square plate on z = 0 with count x count round holes of 32 sides.
inline Mesh perforatedPlate(int count, double pitch_m, double hole_r_m, double thickness_m) {
  constexpr int kSides = 32;
  Mesh mesh;
  std::map<std::array<long long, 3>, std::uint32_t> known;  // vertices by position in nanometres
  const auto vertex = [&](const Vec3& p) {
    const Vec3 nm = 1e9 * p;
    const std::array<long long, 3> key = {std::llround(nm.x()), std::llround(nm.y()), std::llround(nm.z())};
    const auto [at, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(p);
    return at->second;
  };
  const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const std::array<std::uint32_t, 4> v = {vertex(a), vertex(b), vertex(c), vertex(d)};
    mesh.triangles.push_back({v[0], v[1], v[2]});
    mesh.triangles.push_back({v[0], v[2], v[3]});
  };
  const Vec3 up = thickness_m * Vec3::UnitZ();
  for (int i = 0; i < count * count; ++i) {
    const Vec3 center = pitch_m * Vec3(i % count + 0.5, i / count + 0.5, 0);
    for (int k = 0; k < kSides; ++k) {
      const auto along = [&](int side) {
        const double angle = 2 * std::numbers::pi * (side % kSides) / kSides;
        return Vec3(std::cos(angle), std::sin(angle), 0);
      };
      const Vec3 e = along(k), f = along(k + 1);
      const auto border = [&](const Vec3& d) {  // the point in this direction on the square around the hole
        return Vec3(center + 0.5 * pitch_m / d.cwiseAbs().maxCoeff() * d);
      };
      const Vec3 a = center + hole_r_m * e, b = center + hole_r_m * f, c = border(f), d = border(e);
      quad(a + up, d + up, c + up, b + up);
      quad(a, b, c, d);
      quad(a, a + up, b + up, b);
      for (int axis = 0; axis < 2; ++axis)
        for (const double edge_m : {0.0, count * pitch_m})
          if (std::abs(c[axis] - edge_m) < 1e-9 && std::abs(d[axis] - edge_m) < 1e-9)
            quad(d, c, c + up, d + up);
    }
  }
  return mesh;
}

/// A cylinder along z whose corners are unevenly spaced, like a face that was divided along splines. Its
/// facets lean both ways.
inline Mesh unevenCylinder(double radius_m, double length_m, std::uint32_t columns, std::uint32_t rows) {
  Mesh mesh;
  const double across = 2 * std::numbers::pi / columns, along_m = length_m / rows;
  for (std::uint32_t row = 0; row <= rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const double shift = row == 0 || row == rows ? 0 : 0.3 * std::sin(5.0 * column + 3.0 * row),
                   angle = across * (column + shift);
      mesh.vertices.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle),
                                 along_m * (row + shift) - length_m / 2);
    }
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, -length_m / 2);
  mesh.vertices.emplace_back(0, 0, length_m / 2);
  for (std::uint32_t column = 0; column < columns; ++column) {
    const std::uint32_t next = (column + 1) % columns;
    for (std::uint32_t row = 0; row < rows; ++row) {
      const std::uint32_t a = row * columns + column, b = row * columns + next;
      mesh.triangles.push_back({a, b, b + columns});
      mesh.triangles.push_back({a, b + columns, a + columns});
    }
    mesh.triangles.push_back({center, next, column});
    mesh.triangles.push_back({center + 1, rows * columns + column, rows * columns + next});
  }
  return mesh;
}

/// A screw with a round head; its shank points downwards from z = 0.
inline Mesh headed(double shank_m, double length_m, double head_m, double height_m) {
  return test::lathe(
      {{0, -length_m}, {shank_m, -length_m}, {shank_m, 0}, {head_m, 0}, {head_m, height_m}, {0, height_m}},
      64);
}

/// A square cup that stands on z = 0, open at the top.
inline Mesh cup(double size_m, double wall_m) {
  const double h = size_m / 2, in = h - wall_m;
  Mesh mesh = block({-h, -h, 0}, {h, h, wall_m});
  append(mesh, block({-h, -h, 0}, {-in, h, size_m}));
  append(mesh, block({in, -h, 0}, {h, h, size_m}));
  append(mesh, block({-h, -h, 0}, {h, -in, size_m}));
  append(mesh, block({-h, in, 0}, {h, h, size_m}));
  return mesh;
}

inline Mesh blindHole() {
  return test::lathe({{0, -5e-3}, {10e-3, -5e-3}, {10e-3, 20e-3}, {4.02e-3, 20e-3}, {4.02e-3, 0}, {0, 0}},
                     96);
}

/// A dovetail, wider at the bottom, 20 mm long, with 0.1 mm of clearance on each side.
inline Mesh dovetailTail() {
  return prismAlongY({{-9.9e-3, 0}, {9.9e-3, 0}, {5.9e-3, 8e-3}, {-5.9e-3, 8e-3}}, 10e-3);
}
inline Mesh dovetailGroove() {
  Mesh mesh = block({-20e-3, -15e-3, -10e-3}, {20e-3, 15e-3, -0.05e-3});
  for (const double side : {-1.0, 1.0}) {
    std::vector<std::array<double, 2>> wall = {
        {side * 10.5e-3, -1e-3}, {side * 20e-3, -1e-3}, {side * 20e-3, 8e-3}, {side * 6e-3, 8e-3}};
    if (side < 0) std::ranges::reverse(wall);
    append(mesh, prismAlongY(wall, 15e-3));
  }
  return mesh;
}

/// A torus around z.
inline Mesh ring(double radius_m, double thick_m) {
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i < 16; ++i) {
    const double a = 2 * std::numbers::pi * i / 16;
    profile.push_back({radius_m + thick_m * std::cos(a), thick_m * std::sin(a)});
  }
  return test::lathe(profile, 48);
}

/// A box of 40 x 14 x 15 mm with a roof over x < 20 mm; the box is open at the top from 20 mm to 35 mm.
inline Mesh roofedBox(double roof_m = 0.02) {
  Mesh mesh = block({-0.002, -0.01, -0.005}, {0.04, 0.01, 0.0005});
  append(mesh, block({-0.002, -0.01, -0.005}, {0, 0.01, 0.015}));
  append(mesh, block({0.035, -0.01, -0.005}, {0.04, 0.01, 0.015}));
  append(mesh, block({-0.002, -0.01, -0.005}, {0.04, -0.0055, 0.015}));
  append(mesh, block({-0.002, 0.0055, -0.005}, {0.04, 0.01, 0.015}));
  append(mesh, block({-0.002, -0.01, 0.012}, {roof_m, 0.01, 0.015}));
  return mesh;
}

/// A part of a ring, from one angle to another; each facet is a convex prism.
inline Mesh ringPiece(double inner_m, double outer_m, double low_m, double high_m, double from_deg,
                      double to_deg) {
  Mesh mesh;
  const int pieces = static_cast<int>(std::ceil((to_deg - from_deg) / 7.5));
  const auto point = [&](int i, double r, double z) {
    const double a = (from_deg + (to_deg - from_deg) * i / pieces) * std::numbers::pi / 180;
    mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
  };
  for (int i = 0; i <= pieces; ++i) {
    point(i, inner_m, low_m), point(i, outer_m, low_m), point(i, outer_m, high_m), point(i, inner_m, high_m);
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < pieces; ++i) {
    const std::uint32_t at = 4 * static_cast<std::uint32_t>(i), next = at + 4;
    for (std::uint32_t k = 0; k < 4; ++k) quad(at + k, next + k, next + (k + 1) % 4, at + (k + 1) % 4);
  }
  const auto end = static_cast<std::uint32_t>(4 * pieces);
  quad(0, 1, 2, 3);
  quad(end + 3, end + 2, end + 1, end);
  return mesh;
}

/// A plug of 5 mm radius with one lug along x, and a socket with a lip above the lug. The lip has an opening
/// for the lug a quarter of a turn away, and stops at both ends of this turn.
inline Mesh bayonetPlug() {
  Mesh mesh = transformed(makeCylinder(5e-3, 20e-3, 96), Pose::translation({0, 0, 10e-3}));
  append(mesh, ringPiece(4.5e-3, 7e-3, 2e-3, 4e-3, -15, 15));
  return mesh;
}
inline Mesh bayonetSocket() {
  Mesh mesh = transformed(makeCylinder(10e-3, 5e-3, 96), Pose::translation({0, 0, -2.55e-3}));
  for (const auto& [from, to] : {std::pair(-17.0, 107.0), std::pair(107.0, 343.0)}) {
    const bool is_room = from < 0;
    append(mesh, ringPiece(is_room ? 7.1e-3 : 5.05e-3, 10e-3, -0.5e-3, 4.1e-3, from, to));
  }
  append(mesh, ringPiece(5.05e-3, 10e-3, 4.05e-3, 7e-3, -17.5, 73));
  append(mesh, ringPiece(7.1e-3, 10e-3, 4.05e-3, 7e-3, 72.5, 107.5));
  append(mesh, ringPiece(5.05e-3, 10e-3, 4.05e-3, 7e-3, 107, 343));
  return mesh;
}

/// A pocket of 40.2 x 20.2 mm, and two blocks that fill it: the tongue of one reaches into the other.
inline Mesh pocket() {
  Mesh mesh = block({-0.025, -0.015, -0.005}, {0.025, 0.015, 0});
  append(mesh, block({-0.025, -0.015, -0.005}, {-0.0201, 0.015, 0.02}));
  append(mesh, block({0.0201, -0.015, -0.005}, {0.025, 0.015, 0.02}));
  append(mesh, block({-0.025, -0.015, -0.005}, {0.025, -0.0101, 0.02}));
  append(mesh, block({-0.025, 0.0101, -0.005}, {0.025, 0.015, 0.02}));
  return mesh;
}
inline Mesh tongue() {
  Mesh mesh = block({-0.02, -0.01, 0}, {0, 0.01, 0.03});
  append(mesh, block({-0.001, -0.01, 0.0105}, {0.01, 0.01, 0.0195}));
  return mesh;
}
inline Mesh grooved() {
  Mesh mesh = block({0.0001, -0.01, 0}, {0.02, 0.01, 0.01});
  append(mesh, block({0.0001, -0.01, 0.02}, {0.02, 0.01, 0.03}));
  append(mesh, block({0.0105, -0.01, 0.005}, {0.02, 0.01, 0.025}));
  return mesh;
}

}  // namespace vps::scenes
