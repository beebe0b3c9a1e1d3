// SPDX-License-Identifier: BSD-3-Clause
// Detects files that were exported part by part, each in its modelling frame instead of the frame of the
// assembly: all then lie about the origin, and each reaches deep into another.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "import/readers.h"
#include "vps/box_intersection.h"
#include "vps/mesh_distance.h"

namespace vps::scenes::import {
namespace {

/// Whether two coordinates of the box's centre or of its lowest corner are zero, as in a part that is
/// modelled about an axis or from a corner.
bool isAboutOrigin(const Box& box) {
  const double near_m = 1e-3 * box.size().norm();
  int count = 0;
  for (int axis = 0; axis < 3; ++axis)
    count += std::abs(box.center()[axis]) <= near_m || std::abs(box.min[axis]) <= near_m ? 1 : 0;
  return count >= 2;
}

double leastExtent_m(const Box& box) {
  return box.size().minCoeff();
}

/// Points below the surface, spread evenly over it, in the part's frame. Deterministic.
std::vector<Vec3> pointsBelow(const Mesh& mesh, double depth_m, std::size_t count) {
  const double step_m2 = area(mesh) / double(count);
  std::vector<Vec3> points;
  if (!(step_m2 > 0)) return points;
  double done_m2 = 0, a = 0.5, b = 0.5;
  for (const auto& t : mesh.triangles) {
    const Vec3 &p = mesh.vertices[t[0]], u = mesh.vertices[t[1]] - p, v = mesh.vertices[t[2]] - p;
    const Vec3 n = u.cross(v).normalized();
    done_m2 += 0.5 * u.cross(v).norm();
    for (; double(points.size()) + 0.5 < done_m2 / step_m2;
         points.emplace_back(p + a * u + b * v - depth_m * n)) {
      // Multiples of these numbers cover the unit square evenly; the half with a + b > 1 is mirrored into the
      // triangle.
      a = std::fmod(a + 0.7548776662466927, 1);
      b = std::fmod(b + 0.5698402909980532, 1);
      if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
      }
    }
  }
  return points;
}

/// A part, with distances that are prepared when they are first needed.
struct Placed {
  const ImportedPart* part = nullptr;
  Box box = {};  ///< in the world
  std::unique_ptr<const MeshDistance> distance = nullptr;

  /// Whether a ball about this point of the part's frame fits into the part. False for an open mesh, whose
  /// inside only winding numbers would tell, at a cost that such a hint does not justify.
  bool hasBall(const Vec3& p, double radius_m, std::size_t& queries) {
    if (!distance && checkMesh(part->mesh).isClosed()) distance = std::make_unique<MeshDistance>(part->mesh);
    if (!distance) return false;
    ++queries;
    return -distance->signedDistance(p) >= radius_m;
  }
};

struct OneFile {
  std::vector<Placed> parts = {};
  Box box = {};  ///< of all parts, in the world
};

/// The box of all centres of balls that fit into both boxes; empty if no ball fits.
Box middles(const Box& a, const Box& b, double radius_m) {
  return grown(intersection(a, b), -radius_m);
}

/// The greatest number of distances that are computed, about 0.2 s.
constexpr std::size_t kMostQueries = 100'000;

/// The names of two parts, one of each file, for which a ball of this radius at one place fits into both;
/// empty if there are none. Only places below the surfaces of the first file's parts are tried.
std::optional<std::pair<std::string, std::string>> commonBall(OneFile& one, OneFile& other, double radius_m,
                                                              std::size_t& queries) {
  const std::size_t count = std::clamp<std::size_t>(30'000 / one.parts.size(), 20, 300);
  for (Placed& part : one.parts) {
    std::vector<std::pair<Placed*, Box>> near;  // with the box from middles()
    for (Placed& neighbor : other.parts)
      if (const Box both = middles(part.box, neighbor.box, radius_m); !both.isEmpty())
        near.emplace_back(&neighbor, both);
    if (near.empty()) continue;
    for (const Vec3& p : pointsBelow(part.part->mesh, 1.5 * radius_m, count)) {
      const Vec3 p_W = part.part->X_WP * p;
      const auto reaches = [&](const auto& neighbor) { return isWithin(p_W, neighbor.second); };
      if (queries > kMostQueries) return std::nullopt;
      if (std::ranges::none_of(near, reaches) || !part.hasBall(p, radius_m, queries)) continue;
      for (const auto& neighbor : near)
        if (reaches(neighbor) &&
            neighbor.first->hasBall(neighbor.first->part->X_WP.inverse() * p_W, radius_m, queries))
          return std::pair(part.part->name, neighbor.first->part->name);
    }
  }
  return std::nullopt;
}

}  // namespace

std::string ownFramesWarning(const std::vector<ImportedPart>& parts, const std::vector<std::size_t>& ends,
                             std::size_t* query_count) {
  // Radius of the ball, as a fraction of the smaller file's least extent. Threads and press fits overlap by
  // less.
  constexpr double kDeep = 0.1;
  // Greater assemblies get no warning: preparing distances to so many triangles, or comparing the boxes of so
  // many parts, would take too long.
  constexpr std::size_t kMostTriangles = 300'000, kMostParts = 3'000;
  std::size_t triangles = 0, own_count = 0;
  for (const ImportedPart& part : parts) triangles += part.mesh.triangles.size();
  if (ends.size() < 2 || triangles > kMostTriangles || parts.size() > kMostParts) return "";
  std::size_t& queries = query_count != nullptr ? *query_count : own_count;
  std::vector<OneFile> files;
  for (std::size_t i = 0, from = 0; i < ends.size(); from = ends[i++]) {
    if (ends[i] == from) return "";
    OneFile file;
    for (const ImportedPart& part : std::span(parts).subspan(from, ends[i] - from)) {
      Placed& placed = file.parts.emplace_back(&part);
      for (const Vec3& p : part.mesh.vertices) placed.box.add(part.X_WP * p);
      file.box.add(placed.box.min);
      file.box.add(placed.box.max);
    }
    if (!isAboutOrigin(file.box)) return "";
    files.push_back(std::move(file));
  }
  std::pair<std::string, std::string> names;
  for (OneFile& file : files) {
    const bool is_deep = std::ranges::any_of(files, [&](OneFile& other) {
      if (&other == &file) return false;
      const double radius_m = kDeep * std::min(leastExtent_m(file.box), leastExtent_m(other.box));
      auto found = commonBall(file, other, radius_m, queries);
      if (!found) found = commonBall(other, file, radius_m, queries);
      if (found) names = *found;
      return found.has_value();
    });
    if (!is_deep) return "";
  }
  return "the " + std::to_string(files.size()) +
         " files seem to lie in frames of their own: each is placed about the origin, where '" + names.first +
         "' and '" + names.second +
         "' overlap; export them from the assembly, in its frame, or give each a 'pose' in a scene file";
}

}  // namespace vps::scenes::import
