// SPDX-License-Identifier: BSD-3-Clause
// Which axis of a file is up.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "import/readers.h"
#include "vps/box.h"
#include "vps/mesh.h"
#include "vps/mesh_repair.h"

namespace vps::scenes::import {
namespace {

constexpr double kGround = 0.005;  // share of the height within which points count as standing on the ground
constexpr double kShaky_deg = 10;  // assumed: a product is not drawn so that a smaller angle tips it over
constexpr double kFirm_deg = 20;   // assumed

/// The angle at which the parts, as one body, tip over with an axis up: between the vertical and the line
/// from the nearest edge of the base through the centre of mass. Negative where the parts do not stand at
/// all.
double tipsAt_deg(const ImportedCad& cad, int axis) {
  Box box;
  Vec3 com = Vec3::Zero();
  double volume_m3 = 0;
  std::vector<Vec3> points;
  for (const ImportedPart& part : cad.parts) {
    for (const Vec3& p : part.mesh.vertices) points.push_back(part.X_WP * p);
    // Mass properties are those of the repaired solid, since facets may face inwards.
    const MassProperties mass = area(part.mesh) > 0 ? solidMass(part.mesh, part.name) : MassProperties();
    if (!(mass.volume_m3 > 0)) continue;  // a surface without an inside
    com += mass.volume_m3 * (part.X_WP * mass.com);
    volume_m3 += mass.volume_m3;
  }
  for (const Vec3& p : points) box.add(p);
  com = volume_m3 > 0 ? Vec3(com / volume_m3) : box.center();
  const double ground_m = box.min[axis];
  std::erase_if(points, [&](const Vec3& p) { return p[axis] > ground_m + kGround * box.size()[axis]; });
  constexpr int kDirections = 360;
  double least_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    Vec3 u = Vec3::Zero();
    u[(axis + 1) % 3] = std::cos(2 * std::numbers::pi * i / kDirections);
    u[(axis + 2) % 3] = std::sin(2 * std::numbers::pi * i / kDirections);
    double edge_m = -std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) edge_m = std::max(edge_m, u.dot(p - com));
    least_m = std::min(least_m, edge_m);
  }
  const double height_m = com[axis] - ground_m;
  return std::atan2(least_m, std::max(height_m, 1e-12)) * 180 / std::numbers::pi;
}

}  // namespace

void turnUp(ImportedCad& cad, const Vec3& axis) {
  const Pose turn(Quat::FromTwoVectors(axis, Vec3::UnitZ()).toRotationMatrix(), Vec3::Zero());
  for (ImportedPart& part : cad.parts) part.X_WP = turn * part.X_WP;
}

// The format's own axis is kept unless the parts would hardly stand. A flat side is a worse criterion: a
// machine on four feet has a flat top and a flat end.
void guessUp(ImportedCad& cad) {
  if (cad.parts.empty()) return;
  const double y_deg = tipsAt_deg(cad, 1), z_deg = tipsAt_deg(cad, 2);
  const bool is_y = y_deg > kShaky_deg || z_deg < kFirm_deg;
  const auto stability = [](double deg) {
    return deg > 0 ? "tip over at " + std::to_string(std::lround(deg)) + " degrees"
                   : std::string("do not stand");
  };
  std::string formats;
  for (const FormatRow& row : formatRows())
    if (row.is_up_open) formats.append(formats.empty() ? "" : " and ").append(row.name);
  cad.warnings.push_back((is_y ? "y is taken to be up, as " + formats + " define"
                               : "z is taken to be up, although " + formats + " define y") +
                         ": with y up the parts " + stability(y_deg) + ", with z up they " +
                         stability(z_deg) + "; give --up " + (is_y ? "z if z" : "y if y") + " is up");
  if (is_y) turnUp(cad, Vec3::UnitY());
}

}  // namespace vps::scenes::import
