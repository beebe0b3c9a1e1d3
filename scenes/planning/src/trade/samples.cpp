// SPDX-License-Identifier: BSD-3-Clause
#include "trade/samples.h"

#include <cmath>

namespace vps::scenes {

namespace {

void sampleTriangle(const Vec3& a, const Vec3& b, const Vec3& c, double spacing_m, const Box& box,
                    std::vector<SurfaceSample>& samples) {
  Box own;
  for (const Vec3& p : {a, b, c}) own.add(p);
  if ((own.min.array() > box.max.array()).any() || (own.max.array() < box.min.array()).any()) return;
  constexpr double kG = 1.32471795724474602596;  // root of x^3 = x + 1, the constant of the R2 sequence
  const double area_m2 = 0.5 * (b - a).cross(c - a).norm();
  const auto count = static_cast<long>(std::ceil(area_m2 / (spacing_m * spacing_m)));
  for (long i = 0; i < count; ++i) {
    double u = std::fmod(0.5 + static_cast<double>(i + 1) / kG, 1.0);
    double v = std::fmod(0.5 + static_cast<double>(i + 1) / (kG * kG), 1.0);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Vec3 p = a + u * (b - a) + v * (c - a);
    if (isWithin(p, box)) samples.push_back({p, area_m2 / static_cast<double>(count)});
  }
}

}  // namespace

std::vector<SurfaceSample> sampleSurface(const Mesh& mesh, double spacing_m, const Box& box) {
  std::vector<SurfaceSample> samples;
  for (const auto& [a, b, c] : mesh.triangles)
    sampleTriangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], spacing_m, box, samples);
  for (const Vec3& p : mesh.vertices)
    if (isWithin(p, box)) samples.push_back({p, 0});
  return samples;
}

}  // namespace vps::scenes
