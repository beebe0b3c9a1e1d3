// SPDX-License-Identifier: BSD-3-Clause
#include "box_union.h"

#include <algorithm>
#include <cmath>

namespace vps::families {
namespace {

constexpr double kFar_m = 1e3;

double distanceToBox(const Vec3& p, const Box& box) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

Box at(const Vec3& min, const Vec3& size) {
  return {min, min + size};
}

}  // namespace

BoxUnion::BoxUnion(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& planes = planes_[static_cast<std::size_t>(axis)];
    planes = {-kFar_m, kFar_m};
    for (const Box& box : boxes_) planes.insert(planes.end(), {box.min[axis], box.max[axis]});
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  }
}

std::array<std::size_t, 3> BoxUnion::cellCounts() const {
  return {planes_[0].size() - 1, planes_[1].size() - 1, planes_[2].size() - 1};
}

Box BoxUnion::cell(const std::array<std::size_t, 3>& at) const {
  Box cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cell.min[static_cast<int>(axis)] = planes_[axis][at[axis]];
    cell.max[static_cast<int>(axis)] = planes_[axis][at[axis] + 1];
  }
  return cell;
}

bool BoxUnion::isSolid(const Box& cell) const {
  const Vec3 middle = cell.center();
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const Box& box) { return isWithin(middle, box); });
}

template <typename Visit>
void BoxUnion::forEachCell(Visit visit) const {
  const std::array<std::size_t, 3> n = cellCounts();
  for (std::size_t x = 0; x < n[0]; ++x)
    for (std::size_t y = 0; y < n[1]; ++y)
      for (std::size_t z = 0; z < n[2]; ++z) visit(cell({x, y, z}));
}

MassProperties BoxUnion::mass() const {
  MassProperties mass;
  Mat3 second = Mat3::Zero();  // second moments about the origin
  Vec3 first = Vec3::Zero();
  forEachCell([&](const Box& cell) {
    if (!isSolid(cell)) return;
    const Vec3 size = cell.size(), c = cell.center();
    const double volume_m3 = size.prod();
    mass.volume_m3 += volume_m3;
    first += volume_m3 * c;
    second += volume_m3 * (c * c.transpose() + Mat3((size.cwiseAbs2() / 12).asDiagonal()));
  });
  mass.com = first / mass.volume_m3;
  const Mat3 moments = second - mass.volume_m3 * mass.com * mass.com.transpose();
  mass.inertia_m5 = moments.trace() * Mat3::Identity() - moments;
  return mass;
}

double BoxUnion::distance(const Vec3& p) const {
  double to_solid_m = 1e300, to_free_m = 1e300;
  forEachCell([&](const Box& cell) {
    double& least_m = isSolid(cell) ? to_solid_m : to_free_m;
    least_m = std::min(least_m, distanceToBox(p, cell));
  });
  return to_solid_m > 0 ? to_solid_m : -to_free_m;
}

BoxMember boxMember(int i) {
  static const char* const kinds[] = {"U",    "L",      "T",     "cross", "comb", "part of a face",
                                      "edge", "corner", "random"};
  test::Random random(7000 + static_cast<std::uint64_t>(i));
  const int kind = i % 9;
  BoxMember member{kinds[kind], (i / 9) % 2 == 0 ? 0 : random.logUniform(1e-6, 5e-3), {}};
  const double o = member.overlap_m, w = random.uniform(6e-3, 12e-3), h = random.uniform(20e-3, 40e-3),
               l = random.uniform(30e-3, 60e-3);
  const bool is_flush = random.chance(0.5);  // the ends of an arm lie in the planes of the base's faces
  const double in = is_flush ? 0 : random.uniform(0.5e-3, 2e-3);
  const Box base = at({0, 0, 0}, {l, 2 * w, w});
  const auto arm = [&](double x) { return at({x, in, w - o}, {w, 2 * (w - in), h}); };
  switch (kind) {
    case 0:
      member.boxes = {base, arm(in), arm(l - w - in)};
      break;
    case 1:
      member.boxes = {base, arm(in)};
      break;
    case 2:
      member.boxes = {base, arm(0.5 * (l - w))};
      break;
    case 3:
      member.boxes = {at({-w, -w, -w}, {2 * w, 2 * w, 2 * w}),
                      at({w - o, -0.7 * w, -0.7 * w}, {h, 1.4 * w, 1.4 * w}),
                      {{-w - h, -0.7 * w, -0.7 * w}, {-w + o, 0.7 * w, 0.7 * w}},
                      at({-0.7 * w, w - o, -w}, {1.4 * w, h, 2 * w})};
      break;
    case 4: {
      const int teeth = 1 + random.index(8);
      const double length_m = (2.2 * teeth - 1) * w + 2 * in;
      member.boxes = {at({0, 0, 0}, {length_m, 2 * w, w})};
      for (int k = 0; k < teeth; ++k) member.boxes.push_back(arm(in + 2.2 * w * k));
      break;
    }
    case 5:
      member.boxes = {
          base, at({random.uniform(-0.5, 0.5) * l, random.uniform(-0.9, 0.9) * w, w - o}, {l, 2 * w, h})};
      break;
    case 6:  // an edge; with an overlap, along an edge
      member.boxes = {base, at({l - o, 0, w - o}, {w, 2 * w, h})};
      break;
    case 7:
      member.boxes = {base, at({l - o, 2 * w - o, w - o}, {w, h, h})};
      break;
    default: {
      const int count = 2 + random.index(8);
      // Corners lie on a grid of 1 mm, so that faces often lie in one plane.
      const double grid_m = o > 0 ? 0.5 * (1e-3 + o) : 1e-3;
      for (int k = 0; k < count; ++k) {
        const auto draw = [&](int low, int high) { return grid_m * (low + random.index(high - low + 1)); };
        member.boxes.push_back(
            at({draw(0, 20), draw(0, 20), draw(0, 20)}, {draw(4, 20), draw(4, 20), draw(4, 20)}));
      }
    }
  }
  return member;
}

Mesh shellsOf(const std::vector<Box>& boxes, const std::vector<bool>& faces_in) {
  Mesh mesh;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Mesh box = transformed(makeBox(boxes[i].size()), Pose::translation(boxes[i].center()));
    // Faces of one plane get the same coordinates to the bit.
    for (Vec3& v : box.vertices)
      for (int axis = 0; axis < 3; ++axis)
        v[axis] = v[axis] < boxes[i].center()[axis] ? boxes[i].min[axis] : boxes[i].max[axis];
    if (i < faces_in.size() && faces_in[i])
      for (auto& t : box.triangles) std::swap(t[1], t[2]);
    append(mesh, box);
  }
  return mesh;
}

Mesh shellsOf(const std::vector<Box>& boxes) {
  return shellsOf(boxes, {});
}

MassProperties moved(const MassProperties& mass, const Pose& X) {
  return {mass.volume_m3, X * mass.com, X.R * mass.inertia_m5 * X.R.transpose()};
}

double difference(const MassProperties& a, const MassProperties& b, double size_m) {
  return std::max({std::abs(a.volume_m3 / b.volume_m3 - 1), (a.com - b.com).norm() / size_m,
                   (a.inertia_m5 - b.inertia_m5).norm() / b.inertia_m5.norm()});
}

}  // namespace vps::families
