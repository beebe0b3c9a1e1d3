// SPDX-License-Identifier: BSD-3-Clause
// Files that were exported part by part, each in the frame in which it was modelled, and not in that of their
// assembly: then all lie about the origin, and each reaches deep into another.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "import/readers.h"
#include "vps/box.h"
#include "vps/solid.h"

namespace vps::scenes::inline v0::import {
namespace {

/// Whether two coordinates of the box's middle or of its least corner are zero, as of a part that is modelled
/// about an axis or from a corner.
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

/// Points below the surface, spread evenly over it, in the part's frame: the same ones each time.
std::vector<Vec3> pointsBelow(const Mesh& mesh, double depth_m) {
  constexpr int kCount = 300;
  const double step_m2 = area(mesh) / kCount;
  std::vector<Vec3> points;
  if (!(step_m2 > 0)) return points;
  double done_m2 = 0, a = 0.5, b = 0.5;
  for (const auto& t : mesh.triangles) {
    const Vec3 &p = mesh.vertices[t[0]], u = mesh.vertices[t[1]] - p, v = mesh.vertices[t[2]] - p;
    const Vec3 n = u.cross(v).normalized();
    done_m2 += 0.5 * u.cross(v).norm();
    for (; double(points.size()) + 0.5 < done_m2 / step_m2;
         points.emplace_back(p + a * u + b * v - depth_m * n)) {
      // Multiples of these numbers leave no gaps in the unit square; half of it is the triangle.
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

/// A file's parts, with what is inside of each.
struct OneFile {
  std::span<const ImportedPart> parts;
  Box box = {};  ///< of all, in the world
  std::vector<Solid> solids = {};
};

/// Whether a ball of this radius fits into two parts of the files at once, as far as it is found at points
/// below the surface of one's; and which parts these are.
std::optional<std::pair<std::string, std::string>> commonBall(const OneFile& one, const OneFile& other,
                                                              double radius_m) {
  for (std::size_t i = 0; i < one.parts.size(); ++i)
    for (const Vec3& p : pointsBelow(one.parts[i].mesh, 1.5 * radius_m)) {
      if (-one.solids[i].signedDistance(p) < radius_m) continue;
      const Vec3 p_W = one.parts[i].X_WP * p;
      for (std::size_t k = 0; k < other.parts.size(); ++k)
        if (-other.solids[k].signedDistance(other.parts[k].X_WP.inverse() * p_W) >= radius_m)
          return std::pair(one.parts[i].name, other.parts[k].name);
    }
  return std::nullopt;
}

}  // namespace

std::string ownFramesWarning(const std::vector<ImportedPart>& parts, const std::vector<std::size_t>& ends) {
  // Of the smaller one's least extent: more than threads and press fits overlap.
  constexpr double kDeep = 0.1;
  // What is inside of more triangles takes longer to prepare than such a hint is worth.
  constexpr std::size_t kMostTriangles = 300'000;
  std::size_t triangles = 0;
  for (const ImportedPart& part : parts) triangles += part.mesh.triangles.size();
  if (ends.size() < 2 || triangles > kMostTriangles) return "";
  std::vector<OneFile> files;
  for (std::size_t i = 0, from = 0; i < ends.size(); from = ends[i++]) {
    OneFile file{std::span(parts).subspan(from, ends[i] - from)};
    for (const ImportedPart& part : file.parts)
      for (const Vec3& p : part.mesh.vertices) file.box.add(part.X_WP * p);
    if (!isAboutOrigin(file.box)) return "";
    files.push_back(std::move(file));
  }
  for (OneFile& file : files)
    for (const ImportedPart& part : file.parts) file.solids.emplace_back(part.mesh, part.name);
  std::pair<std::string, std::string> names;
  for (const OneFile& file : files) {
    const bool is_deep = std::ranges::any_of(files, [&](const OneFile& other) {
      if (&other == &file) return false;
      const double radius_m = kDeep * std::min(leastExtent_m(file.box), leastExtent_m(other.box));
      auto found = commonBall(file, other, radius_m);
      if (!found) found = commonBall(other, file, radius_m);
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

}  // namespace vps::scenes::inline v0::import
