// SPDX-License-Identifier: BSD-3-Clause
// A threaded rod and its nut, with real helical flanks.
//
// Rows of vertices run along the helix, so that crests and roots are clean edges; at the two end faces rows
// are clamped to the face, where they fall together and are merged.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/swept.h"

namespace vps::test {

struct ThreadShape {
  double major_m = 6e-3;  ///< outer radius of the rod's crests (M12)
  double pitch_m = 1.75e-3;
  double length_m = 20e-3;
  double clearance_m = 0;   ///< radial, given to every point of the flanks, crests and roots
  double chamfer_m = 0;     ///< at 45 degrees, of both ends: into the rod's crests, and into the nut's
  int columns = 192;        ///< around; a multiple of 6
  int rows_per_pitch = 32;  ///< a multiple of 16, so that crest and root begin on a row
  int face_steps = 12;      ///< across the end faces
  int side_steps = 24;      ///< along the nut's outside
};

/// Radius of the rod at `turns` pitches along the thread: ISO metric basic profile, 60 degrees, crest P/8,
/// root P/4.
inline double threadRadius(const ThreadShape& thread, double turns) {
  const double u = turns - std::floor(turns);
  constexpr double kCrest = 1.0 / 8, kFlank = 5.0 / 16;
  const double along = u < kCrest ? 0 : std::min({(u - kCrest) / kFlank, 1.0, (1 - u) / kFlank});
  return thread.major_m - along * kFlank * thread.pitch_m * std::sqrt(3.0);
}

/// Chamfered at the ends: a rod beyond its crests, a nut within its roots.
inline double chamferedRadius(const ThreadShape& thread, bool is_nut, double radius_m, double z_m) {
  if (thread.chamfer_m <= 0) return radius_m;
  const double cut_m = thread.chamfer_m - (thread.length_m / 2 - std::abs(z_m));
  const double crest_m = thread.major_m + thread.clearance_m,
               root_m = crest_m - 5.0 / 16 * std::sqrt(3.0) * thread.pitch_m;
  return is_nut ? std::max(radius_m, root_m + cut_m) : std::min(radius_m, crest_m - cut_m);
}

/// Points of the helical surface above column i, from the lower end face to the upper.
inline std::vector<Vec3> threadColumn(const ThreadShape& thread, int i, bool is_nut) {
  const double half_m = thread.length_m / 2, row_m = thread.pitch_m / thread.rows_per_pitch;
  const double angle_rad = kTurn_rad * (i % thread.columns) / thread.columns;
  const int half_rows = static_cast<int>(std::ceil(half_m / row_m));
  std::vector<Vec3> column;
  for (int j = -half_rows - thread.rows_per_pitch; j <= half_rows; ++j) {
    // A row climbs one pitch a turn, so the last column is the first one a pitch higher, to the bit.
    const double row = j + static_cast<double>(thread.rows_per_pitch) * i / thread.columns;
    const double z_m = std::clamp(row * row_m, -half_m, half_m);
    const double phase = static_cast<double>(i % thread.columns) / thread.columns;
    const double turns =
        z_m == row * row_m ? static_cast<double>(j) / thread.rows_per_pitch : z_m / thread.pitch_m - phase;
    const double radius_m = threadRadius(thread, turns) + thread.clearance_m;
    column.push_back(polar(chamferedRadius(thread, is_nut, radius_m, z_m), angle_rad, z_m));
  }
  return column;
}

/// A rod with a right-hand thread over all its length, around z, centred. Closed, outward; about
/// 2 x columns x rows_per_pitch x length / pitch triangles on the thread.
inline Mesh makeThreadedRod(const ThreadShape& thread) {
  const Vec3 end(0, 0, thread.length_m / 2);
  return sweptSections(thread.columns, [&](int i) {
    std::vector<Vec3> loop = threadColumn(thread, i, false);
    const Vec3 low = loop.front(), high = loop.back();
    loop.pop_back();
    appendLine(loop, high, end, thread.face_steps);
    loop.push_back(end);
    appendLine(loop, -end, low, thread.face_steps);
    return loop;
  });
}

/// In a mirror a right-hand thread is a left-hand one.
inline Mesh mirrored(Mesh mesh) {
  for (Vec3& v : mesh.vertices) v.x() = -v.x();
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

/// A hexagonal nut with the same thread inside, its corners at corner_m. Closed, outward.
inline Mesh makeNut(const ThreadShape& thread, double corner_m) {
  return sweptSections(thread.columns, [&](int i) {
    std::vector<Vec3> column = threadColumn(thread, i, true);
    std::reverse(column.begin(), column.end());
    const double angle_rad = kTurn_rad * (i % thread.columns) / thread.columns;
    const Vec3 side = polar(polygonRadius(corner_m, 6, angle_rad), angle_rad, 0);
    const Vec3 up(0, 0, thread.length_m / 2);
    std::vector<Vec3> loop;
    appendLine(loop, side - up, side + up, thread.side_steps);
    appendLine(loop, side + up, column.front(), thread.face_steps);
    loop.insert(loop.end(), column.begin(), column.end() - 1);
    appendLine(loop, column.back(), side - up, thread.face_steps);
    return loop;
  });
}

}  // namespace vps::test
