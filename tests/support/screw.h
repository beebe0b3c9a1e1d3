// SPDX-License-Identifier: BSD-3-Clause
// A threaded rod and its nut, with real helical flanks.
//
// Rows of vertices run along the helix, so that crests and roots are clean edges. At the two end faces, the
// rows are clamped to the face, where coinciding vertices are merged.
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
  double clearance_m = 0;   ///< radial offset of every point of the flanks, crests and roots
  double chamfer_m = 0;     ///< chamfer of 45 degrees at both ends, into the crests of rod and nut
  int columns = 192;        ///< columns around the axis; a multiple of 6
  int rows_per_pitch = 32;  ///< a multiple of 16, so that crest and root begin on a row
  int face_steps = 12;      ///< steps across the end faces
  int side_steps = 24;      ///< steps along the nut's outside
};

/// Radius of the rod at `turns` pitches along the thread: ISO metric basic profile, 60 degrees, crest P/8,
/// root P/4.
inline double threadRadius(const ThreadShape& thread, double turns) {
  const double u = turns - std::floor(turns);
  constexpr double kCrest = 1.0 / 8, kFlank = 5.0 / 16;
  const double along = u < kCrest ? 0 : std::min({(u - kCrest) / kFlank, 1.0, (1 - u) / kFlank});
  return thread.major_m - along * kFlank * thread.pitch_m * std::sqrt(3.0);
}

/// The radius with the chamfer at the ends: it limits a rod's radius from above and a nut's from below.
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
    // A row rises by one pitch per turn, so the last column is the first column raised by a pitch, to the
    // bit.
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

/// A centred rod around z with a right-hand thread over its whole length. The mesh is closed, faces outwards,
/// and has about 2 x columns x rows_per_pitch x length / pitch triangles on the thread.
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

/// The mirrored mesh: a right-hand thread becomes a left-hand one.
inline Mesh mirrored(Mesh mesh) {
  for (Vec3& v : mesh.vertices) v.x() = -v.x();
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

/// A hexagonal nut with the same thread inside and its corners at the radius corner_m. The mesh is closed and
/// faces outwards.
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
