// SPDX-License-Identifier: BSD-3-Clause
// Meshes with one kind of fault each, made from closed meshes, so that the true solid is known.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/analytic.h"
#include "vps/mesh_distance.h"
#include "vps/winding_number.h"

namespace vps::test {

/// A mesh and the closed surface that it stands for.
struct FaultyMesh {
  std::string fault;
  Mesh mesh;
  /// Signed distance of the true solid, negative inside.
  std::function<double(const Vec3&)> truth;
  /// Greatest distance between the mesh and the true surface, away from holes [m].
  double error_m = 0;
  /// True for points near missing facets, at which tests compare neither sign nor distance. May be empty.
  std::function<bool(const Vec3&)> isByHole;
  /// If true, `truth` gives only the sign inside the solid.
  bool is_union = false;
};

namespace faulty {

using Truth = std::function<double(const Vec3&)>;

/// The signed distance of a closed mesh without faults.
inline Truth distanceTo(const Mesh& closed) {
  return [exact = std::make_shared<MeshDistance>(closed)](const Vec3& p) { return exact->signedDistance(p); };
}
/// The signed distance of the union. Inside the union, only the sign of the result is right.
inline Truth either(Truth a, Truth b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) { return std::min(a(p), b(p)); };
}
inline Truth without(Truth a, Truth b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) { return std::max(a(p), -b(p)); };
}

inline Pose pose() {
  return RandomPoints(2).pose(0.01);  // no face is aligned with the grid
}
inline Mesh tube() {
  return transformed(makeTube(0.01, 0.006, 0.012, 32), pose());
}
inline Mesh ball() {
  return transformed(makeSphere(0.008, 3), pose());
}
inline Mesh block(const Vec3& size_m, const Vec3& at = Vec3::Zero()) {
  return transformed(makeBox(size_m), pose() * Pose(Mat3::Identity(), at));
}

/// A bracket: a U-shaped profile, extruded by 12 mm. Concave, with long thin facets.
inline Mesh bracket() {
  const std::vector<std::array<double, 2>> u = {{0, 0},  {16, 0}, {16, 12}, {12, 12},
                                                {12, 4}, {4, 4},  {4, 12},  {0, 12}};
  Mesh mesh;
  for (const double z : {-6.0, 6.0})
    for (const auto& [x, y] : u) mesh.vertices.emplace_back(1e-3 * (x - 8), 1e-3 * (y - 6), 1e-3 * z);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < 8; ++i) quad(i, (i + 1) % 8, (i + 1) % 8 + 8, i + 8);
  for (const auto& [a, b, c, d] : {std::array{0u, 1u, 4u, 5u}, {1u, 2u, 3u, 4u}, {0u, 5u, 6u, 7u}}) {
    quad(a + 8, b + 8, c + 8, d + 8);
    quad(d, c, b, a);
  }
  return transformed(mesh, pose());
}

/// A prism of 16 mm over a triangle whose sharpest edge has 25 degrees. Near this edge, a point outside may
/// lie behind the plane of one of its two faces.
inline Mesh wedge() {
  Mesh mesh;
  for (const double z : {-0.008, 0.008})
    for (const auto& [x, y] : {std::pair{-0.008, 0.0}, {0.01, 0.0}, {0.01, 0.0084}})
      mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {3, 0, 4}, {1, 2, 5}, {4, 1, 5}, {2, 0, 3}, {5, 2, 3}};
  return transformed(mesh, pose());
}

inline void turn(std::array<std::uint32_t, 3>& t) {
  std::swap(t[1], t[2]);
}
inline Mesh turned(Mesh mesh) {
  for (auto& t : mesh.triangles) turn(t);
  return mesh;
}
/// The mesh with separate corners for each facet, moved by up to jitter_m along each axis.
inline Mesh unwelded(const Mesh& mesh, double jitter_m) {
  RandomPoints random(11);
  Mesh soup;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t)
      soup.vertices.push_back(mesh.vertices[v] + random.inBox(Vec3::Constant(jitter_m)));
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}
/// Cuts each given facet at its first side and leaves the neighbour whole. The new corner is off_m away.
inline Mesh withTJunctions(Mesh mesh, const std::vector<std::size_t>& facets, double off_m) {
  RandomPoints random(12);
  for (const std::size_t i : facets) {
    const auto [a, b, c] = mesh.triangles[i];
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(0.4 * mesh.vertices[a] + 0.6 * mesh.vertices[b] +
                            off_m * random.inBox(Vec3::Ones()).normalized());
    mesh.triangles[i] = {a, middle, c};
    mesh.triangles.push_back({middle, b, c});
  }
  return mesh;
}
/// Fills every T-junction of withTJunctions() with a triangle of zero area.
inline Mesh withCollinearFacets(Mesh mesh, const std::vector<std::size_t>& facets) {
  for (const std::size_t i : facets) {
    const auto [a, b, c] = mesh.triangles[i];
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    mesh.triangles[i] = {a, middle, c};
    mesh.triangles.push_back({middle, b, c});
    mesh.triangles.push_back({a, b, middle});
  }
  return mesh;
}
inline std::vector<std::size_t> every(std::size_t step, const Mesh& mesh) {
  std::vector<std::size_t> facets;
  for (std::size_t i = step / 2; i < mesh.triangles.size(); i += step) facets.push_back(i);
  return facets;
}
inline Mesh joined(Mesh a, const Mesh& b) {
  append(a, b);
  return a;
}

/// Removes facets. The neighbourhood of a hole is a ball around each removed facet.
inline FaultyMesh punched(const std::string& fault, const Mesh& closed,
                          const std::vector<std::size_t>& facets) {
  FaultyMesh made{fault, closed, distanceTo(closed), 0, {}, false};
  std::vector<std::pair<Vec3, double>> balls;
  std::vector<std::uint8_t> is_gone(closed.triangles.size(), 0);
  for (const std::size_t i : facets) {
    is_gone[i] = 1;
    const auto [a, b, c] = closed.triangles[i];
    const Vec3 middle = (closed.vertices[a] + closed.vertices[b] + closed.vertices[c]) / 3;
    const double radius_m =
        std::max({(closed.vertices[a] - middle).norm(), (closed.vertices[b] - middle).norm(),
                  (closed.vertices[c] - middle).norm()});
    balls.emplace_back(middle, radius_m);
  }
  made.mesh.triangles.clear();
  for (std::size_t i = 0; i < is_gone.size(); ++i)
    if (is_gone[i] == 0) made.mesh.triangles.push_back(closed.triangles[i]);
  // Within the ball of a hole the sign is not compared. Farther away, the nearest point of the true surface
  // may still be in the hole; then the distance is not compared either.
  made.isByHole = [balls, exact = std::make_shared<MeshDistance>(closed)](const Vec3& p) {
    const Vec3 q = exact->closest(p).q;
    return std::any_of(balls.begin(), balls.end(), [&](const auto& ball) {
      return (p - ball.first).norm() < 1.5 * ball.second || (q - ball.first).norm() < 1.001 * ball.second;
    });
  };
  return made;
}

/// A block in two halves that share a wall.
inline Mesh halves(int walls) {
  Mesh mesh;
  for (const double x : {-0.008, 0.0, 0.008})
    for (const auto& [y, z] : {std::pair{-0.004, -0.005}, {0.004, -0.005}, {0.004, 0.005}, {-0.004, 0.005}})
      mesh.vertices.emplace_back(x, y, z);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (const std::uint32_t ring : {0u, 4u})
    for (std::uint32_t i = 0; i < 4; ++i)
      quad(ring + i, ring + i + 4, ring + (i + 1) % 4 + 4, ring + (i + 1) % 4);
  quad(0, 1, 2, 3);
  quad(8, 11, 10, 9);
  mesh = turned(mesh);
  if (massProperties(mesh).volume_m3 < 0) mesh = turned(mesh);
  if (walls >= 1) quad(4, 5, 6, 7);
  if (walls >= 2) quad(7, 6, 5, 4);
  return transformed(mesh, pose());
}

/// A plate with a dent from above and one from below that meet in one vertex.
inline Mesh pinched() {
  Mesh mesh;
  constexpr std::uint32_t kSides = 16;
  const auto ring = [&](double r, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double angle_rad = 2 * std::numbers::pi * i / kSides;
      mesh.vertices.emplace_back(r * std::cos(angle_rad), r * std::sin(angle_rad), z);
    }
    return first;
  };
  const std::uint32_t low_in = ring(0.005, -0.003), low = ring(0.01, -0.003), high = ring(0.01, 0.003),
                      high_in = ring(0.005, 0.003);
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, 0);
  const auto band = [&](std::uint32_t a, std::uint32_t b) {
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const std::uint32_t j = (i + 1) % kSides;
      mesh.triangles.push_back({a + i, a + j, b + j});
      mesh.triangles.push_back({a + i, b + j, b + i});
    }
  };
  band(low_in, low);
  band(low, high);
  band(high, high_in);
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t j = (i + 1) % kSides;
    mesh.triangles.push_back({high_in + i, high_in + j, tip});
    mesh.triangles.push_back({low_in + j, low_in + i, tip});
  }
  return transformed(mesh, pose());
}
/// The signed distance of a closed, pinched mesh that faces outwards: the distance to all facets, with the
/// sign by the winding number of all facets.
inline Truth exhaustive(const Mesh& mesh) {
  return [mesh, winding = std::make_shared<WindingNumber>(mesh)](const Vec3& p) {
    double least2 = 1e300;
    for (const auto& t : mesh.triangles)
      least2 = std::min(
          least2, (closestOnTriangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).q - p)
                      .squaredNorm());
    return winding->exact(p) > 0.5 ? -std::sqrt(least2) : std::sqrt(least2);
  };
}

}  // namespace faulty

/// One mesh for each kind of fault.
inline std::vector<FaultyMesh> faultyMeshes() {
  using namespace faulty;
  std::vector<FaultyMesh> all;
  const auto add = [&](const char* fault, Mesh mesh, const Mesh& closed, double error_m = 0) {
    all.push_back({fault, std::move(mesh), distanceTo(closed), error_m, {}, false});
  };
  const auto addTruth = [&](const char* fault, Mesh mesh, Truth truth, double error_m = 0) {
    all.push_back({fault, std::move(mesh), std::move(truth), error_m, {}, true});
  };
  const Mesh ring = tube(), u = bracket(), sphere = ball();
  // If a corner moves by j along each axis, the facet moves by sqrt(3) j at most.
  constexpr double kJitter = 1.7320509;

  add("closed tube", ring, ring);
  add("closed bracket", u, u);
  add("flipped whole", turned(u), u);
  Mesh some = ring;
  for (const std::size_t i : every(7, some)) turn(some.triangles[i]);
  add("some facets flipped", some, ring);
  add("unwelded", unwelded(u, 0), u);
  Mesh unwelded_turned = unwelded(ring, 0);
  for (const std::size_t i : every(5, unwelded_turned)) turn(unwelded_turned.triangles[i]);
  add("unwelded and flipped", unwelded_turned, ring);
  add("cracks of 0.1 um", unwelded(u, 1e-7), u, kJitter * 1e-7);
  add("cracks of 20 um", unwelded(ring, 1e-5), ring, kJitter * 1e-5);
  add("T-junctions", withTJunctions(ring, every(5, ring), 0), ring, 1e-12);
  add("T-junctions of a bracket", withTJunctions(u, every(2, u), 0), u, 1e-12);
  add("T-junctions of a wedge", withTJunctions(wedge(), every(2, wedge()), 0), wedge(), 1e-12);
  add("T-junctions of a wedge, 1 um apart", withTJunctions(wedge(), every(2, wedge()), 1e-6), wedge(), 1e-6);
  add("T-junctions open by 2 um", withTJunctions(u, every(2, u), 2e-6), u, 2e-6);
  add("facets without area", withCollinearFacets(ring, every(5, ring)), ring, 1e-12);
  // Slivers: facets that are cut at a corner a micrometre away from their first side, on either side of it.
  Mesh sliced = u;
  for (const std::size_t i : every(3, u)) {
    const auto [a, b, c] = sliced.triangles[i];
    const Vec3 middle = 0.5 * (u.vertices[a] + u.vertices[b]);
    const auto v = static_cast<std::uint32_t>(sliced.vertices.size());
    sliced.vertices.push_back(middle + 1e-6 * (u.vertices[c] - middle).normalized());
    sliced.triangles[i] = {a, b, v};
    sliced.triangles.push_back({b, c, v});
    sliced.triangles.push_back({c, a, v});
  }
  // The barycentric weights of a point in a facet of length L and height H have an error of 1e-16 (L / H)^2,
  // which moves the point by 4e-10 m along the facet. At a distance d of 1e-8 m this is an error of (4e-10)^2
  // / 2d = 8e-12 m.
  add("slivers", sliced, u, 1e-11);
  Mesh twice = ring;
  for (const std::size_t i : every(3, ring)) twice.triangles.push_back(ring.triangles[i]);
  add("duplicate facets", twice, ring);
  Mesh both = u;
  for (const auto& t : turned(u).triangles) both.triangles.push_back(t);
  add("exported for both sides", both, u);
  add("the whole mesh twice", joined(u, u), u);
  Mesh near = ring;
  for (Vec3& p : near.vertices) p += 3e-7 * Vec3(1, 2, -1).normalized();
  add("the whole mesh twice, 0.3 um apart", joined(ring, near), ring, 3e-7);
  all.push_back(punched("one facet of a ball missing", sphere, {17}));
  all.push_back(punched("every fortieth facet missing", sphere, every(40, sphere)));
  all.push_back(punched("a bracket's facet missing", u, {3}));
  const Vec3 size = {0.016, 0.008, 0.01};
  add("inner wall", halves(1), block(size));
  add("double inner wall", halves(2), block(size));
  const Mesh one = block({0.012, 0.006, 0.005}), two = block({0.006, 0.014, 0.004}, {0.001, 0.002, 0.0013});
  addTruth("overlapping shells", joined(one, two), either(distanceTo(one), distanceTo(two)));
  addTruth("overlapping shells, one flipped", joined(one, turned(two)),
           either(distanceTo(one), distanceTo(two)));
  const Mesh flush = block({0.006, 0.01, 0.005}, {0.002, 0.003, 0});  // top and bottom in common planes
  addTruth("overlapping shells with faces in one plane", joined(one, flush),
           either(distanceTo(one), distanceTo(flush)));
  const Mesh beside = block({0.004, 0.009, 0.003}, {0.008, 0.001, 0.0004});  // touches one's face x = 6 mm
  addTruth("shells that touch", joined(one, beside), either(distanceTo(one), distanceTo(beside)));
  addTruth("two shells, one flipped",
           joined(one, turned(block({0.004, 0.009, 0.003}, {0.01, 0.001, 0.0004}))),
           either(distanceTo(one), distanceTo(block({0.004, 0.009, 0.003}, {0.01, 0.001, 0.0004}))));
  const Mesh small = transformed(makeSphere(0.005, 2), pose());
  add("a shell within a shell", joined(sphere, small), sphere);
  addTruth("a cavity", joined(sphere, turned(small)), without(distanceTo(sphere), distanceTo(small)));
  addTruth("a cavity, all flipped", turned(joined(sphere, turned(small))),
           without(distanceTo(sphere), distanceTo(small)));
  // Two blocks that share one edge.
  const Mesh left = block({0.006, 0.006, 0.01}, {-0.003, -0.003, 0}),
             right = block({0.006, 0.006, 0.01}, {0.003, 0.003, 0});
  addTruth("an edge with four facets", welded(joined(left, right), 1e-9),
           either(distanceTo(left), distanceTo(right)), 1e-9);
  all.push_back({"two dents that meet in a vertex", pinched(), exhaustive(pinched()), 1e-12, {}, false});
  const Mesh plate = block({0.016, 0.012, 0.15e-3});
  add("a wall thinner than a voxel", plate, plate);
  add("a thin wall with T-junctions, flipped", turned(withTJunctions(plate, every(2, plate), 0)), plate,
      1e-12);
  Mesh with_sheet = u;
  const Vec3 o = bounds(u).max + Vec3(0.002, 0, 0);
  const auto first = static_cast<std::uint32_t>(with_sheet.vertices.size());
  with_sheet.vertices.insert(with_sheet.vertices.end(),
                             {o, o + Vec3(0.006, 0, 0.001), o + Vec3(0, 0.006, 0)});
  with_sheet.triangles.push_back({first, first + 1, first + 2});
  all.push_back({"a sheet next to a solid", with_sheet, distanceTo(u), 0,
                 [o, truth = distanceTo(u)](const Vec3& p) {
                   return (p - o).norm() < truth(p) + 0.007;  // the sheet may be nearer
                 },
                 false});
  return all;
}

}  // namespace vps::test
