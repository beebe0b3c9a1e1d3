// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/curved_features.h"

#include <array>

#include "vps/contact_tolerances.h"

namespace vps {

namespace {

enum class Turn { Flat, Slight, Sharp };

Turn turnBetween(const Vec3& a, const Vec3& b) {
  if (!(a.dot(b) > kCosCurved)) return Turn::Sharp;
  return a.cross(b).norm() > kSinFlat ? Turn::Slight : Turn::Flat;
}

}  // namespace

bool isSmoothEdge(const Vec3& normal0, const Vec3& normal1, bool is_one_curved, double width_m) {
  const Turn turn = turnBetween(normal0, normal1);
  // An arc that turns by the angle between the normals, and whose chord is width_m, rises above the chord by
  // width times angle / 8.
  const double rise_m = width_m * normal0.cross(normal1).norm() / 8;
  return turn == Turn::Flat || (turn == Turn::Slight && is_one_curved && rise_m < 0.5 * kSamePlace_m);
}

std::vector<std::uint8_t> findCurvedFacets(std::span<const HalfEdge> edges, std::span<const Vec3> normals) {
  Groups planes(normals.size());
  std::vector<std::array<std::uint32_t, 2>> slight;  // triangles
  forEachEdge(edges, [&](std::span<const HalfEdge> same) {
    if (same.size() != 2 || same[0].is_forward == same[1].is_forward) return;
    const Vec3 &a = normals[same[0].triangle], &b = normals[same[1].triangle];
    if (a.isZero() || b.isZero()) return;
    const Turn turn = turnBetween(a, b);
    if (turn == Turn::Flat) planes.join(same[0].triangle, same[1].triangle);
    if (turn == Turn::Slight) slight.push_back({same[0].triangle, same[1].triangle});
  });
  constexpr std::uint32_t kNone = ~0U;
  // Neighbour of a plane, by the plane's first triangle.
  std::vector<std::uint32_t> neighbour(normals.size(), kNone);
  std::vector<std::uint8_t> has_two(normals.size(), 0), is_curved(normals.size(), 0);
  const auto addNeighbour = [&](std::uint32_t plane, std::uint32_t other) {
    if (neighbour[plane] == kNone) neighbour[plane] = other;
    if (neighbour[plane] != other) has_two[plane] = 1;
  };
  for (auto& [a, b] : slight) {
    a = planes.find(a), b = planes.find(b);
    addNeighbour(a, b);
    addNeighbour(b, a);
  }
  for (const auto& [a, b] : slight)
    if (has_two[a] != 0 || has_two[b] != 0) is_curved[a] = is_curved[b] = 1;
  for (std::uint32_t i = 0; i < normals.size(); ++i) is_curved[i] = is_curved[planes.find(i)];
  return is_curved;
}

}  // namespace vps
