// SPDX-License-Identifier: BSD-3-Clause
#include "faults.h"

namespace vps::search {

namespace {

std::uint32_t add(Mesh& mesh, const Vec3& p) {
  mesh.vertices.push_back(p);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

Mesh withoutSharedVertices(const Mesh& mesh) {
  Mesh soup;
  for (const auto& t : mesh.triangles)
    soup.triangles.push_back(
        {add(soup, mesh.vertices[t[0]]), add(soup, mesh.vertices[t[1]]), add(soup, mesh.vertices[t[2]])});
  return soup;
}

/// Moves some corners of some facets, which opens cracks along the sides of these facets.
void crack(Mesh& soup, Random& random) {
  for (Vec3& p : soup.vertices)
    if (random.chance(0.2)) p += random.direction() * random.uniform(0, kCrack_m);
}

/// Splits a facet at the middle of its longest side; its neighbour there is not split.
void addTJunction(Mesh& soup, Random& random) {
  auto& t = soup.triangles[static_cast<std::size_t>(random.index(static_cast<int>(soup.triangles.size())))];
  std::size_t longest = 0;
  const auto length_m = [&](std::size_t k) {
    return (soup.vertices[t[(k + 1) % 3]] - soup.vertices[t[k]]).norm();
  };
  for (std::size_t k = 1; k < 3; ++k)
    if (length_m(k) > length_m(longest)) longest = k;
  const std::uint32_t a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
  const std::uint32_t middle = add(soup, 0.5 * (soup.vertices[a] + soup.vertices[b]));
  t = {a, middle, c};
  soup.triangles.push_back({middle, b, c});
}

void turn(std::array<std::uint32_t, 3>& triangle) {
  std::swap(triangle[1], triangle[2]);
}

void addFault(Mesh& soup, int kind, Random& random) {
  switch (kind) {
    case 0:
      return crack(soup, random);
    case 1:
      for (int i = random.index(5); i >= 0; --i) addTJunction(soup, random);
      return;
    case 2:
      turn(soup.triangles[static_cast<std::size_t>(random.index(static_cast<int>(soup.triangles.size())))]);
      return;
    case 3:
      for (auto& t : soup.triangles) turn(t);
      return;
    case 4:
      soup.triangles.push_back(soup.triangles.front());
      return;
    default:
      return;  // the facets of the soup share no vertices, which is the fault
  }
}

}  // namespace

Mesh withFaults(const Mesh& mesh, Random& random) {
  Mesh soup = withoutSharedVertices(mesh);
  for (int i = random.index(3); i >= 0; --i) addFault(soup, random.index(6), random);
  return soup;
}

}  // namespace vps::search
