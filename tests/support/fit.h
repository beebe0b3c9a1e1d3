// SPDX-License-Identifier: BSD-3-Clause
// A round peg, a square plate with a bore for the peg, and a torus, which has no sharp edge.
#pragma once

#include <cmath>
#include <vector>

#include "support/swept.h"

namespace vps::test {

struct PegShape {
  double radius_m = 5e-3;
  double length_m = 40e-3;
  double chamfer_m = 0.5e-3;
  int columns = 1024;
  int rows = 60;
};

/// A centred, chamfered peg around z. The mesh is closed and faces outwards; vertices lie on the true
/// circles.
inline Mesh makePeg(const PegShape& peg) {
  const Vec3 up(0, 0, peg.length_m / 2);
  return sweptSections(peg.columns, [&](int i) {
    const double angle_rad = kTurn_rad * (i % peg.columns) / peg.columns;
    const Vec3 wall = polar(peg.radius_m, angle_rad, 0),
               rim = polar(peg.radius_m - peg.chamfer_m, angle_rad, 0);
    const Vec3 chamfer(0, 0, peg.chamfer_m);
    std::vector<Vec3> loop;
    appendLine(loop, rim - up, wall - up + chamfer, 2);
    appendLine(loop, wall - up + chamfer, wall + up - chamfer, peg.rows);
    appendLine(loop, wall + up - chamfer, rim + up, 2);
    appendLine(loop, rim + up, up, 8);
    loop.push_back(up);
    appendLine(loop, -up, rim - up, 8);
    return loop;
  });
}

struct PlateShape {
  double side_m = 60e-3;
  double height_m = 20e-3;
  double bore_m = 5e-3;  ///< radius
  int columns = 1024;    ///< a multiple of 4
  int bore_rows = 50;
  int face_steps = 16;
  int side_rows = 16;
};

/// A centred square plate around z with a round bore. The mesh is closed, faces outwards, and has columns x 2
/// (bore_rows + side_rows + 2 face_steps) triangles.
inline Mesh makeBoredPlate(const PlateShape& plate) {
  const Vec3 up(0, 0, plate.height_m / 2);
  return sweptSections(plate.columns, [&](int i) {
    const double angle_rad = kTurn_rad * (i % plate.columns) / plate.columns;
    const Vec3 bore = polar(plate.bore_m, angle_rad, 0);
    const Vec3 side = polar(polygonRadius(plate.side_m / std::sqrt(2.0), 4, angle_rad), angle_rad, 0);
    std::vector<Vec3> loop;
    appendLine(loop, side - up, side + up, plate.side_rows);
    appendLine(loop, side + up, bore + up, plate.face_steps);
    appendLine(loop, bore + up, bore - up, plate.bore_rows);
    appendLine(loop, bore - up, side - up, plate.face_steps);
    return loop;
  });
}

/// A torus around z. The mesh is closed, faces outwards, and has 2 x columns x rows triangles; vertices lie
/// on the true torus.
inline Mesh makeTorus(double ring_m, double tube_m, int columns, int rows) {
  return sweptSections(columns, [&](int i) {
    const double angle_rad = kTurn_rad * (i % columns) / columns;
    std::vector<Vec3> loop;
    for (int k = 0; k < rows; ++k) {
      const double around_rad = kTurn_rad * k / rows;
      loop.push_back(polar(ring_m + tube_m * std::cos(around_rad), angle_rad, tube_m * std::sin(around_rad)));
    }
    return loop;
  });
}

}  // namespace vps::test
