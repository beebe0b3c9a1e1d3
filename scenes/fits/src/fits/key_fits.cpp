// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "fits/fits.h"
#include "fits/iso_sizes.h"

namespace vps::scenes {

namespace {

constexpr double kLeastFacing = 0.3;       // share of the smaller face that the other face covers
constexpr double kKeyFitsParallel = 1e-4;  // greatest angle between parallel faces [rad]

using Vec2 = Eigen::Vector2d;
using Polygon = std::vector<Vec2>;

double twiceArea(const Polygon& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 &a = p[i], &b = p[(i + 1) % p.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// The part of a convex polygon to the left of ab. Source: Sutherland and Hodgman 1974.
Polygon clipped(const Polygon& p, const Vec2& a, const Vec2& b) {
  Polygon out;
  const auto left = [&](const Vec2& x) {
    return (b.x() - a.x()) * (x.y() - a.y()) - (b.y() - a.y()) * (x.x() - a.x());
  };
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 &from = p[i], &to = p[(i + 1) % p.size()];
    const double at_from = left(from), at_to = left(to);
    if (at_from >= 0) out.push_back(from);
    if ((at_from >= 0) != (at_to >= 0)) out.push_back(from + at_from / (at_from - at_to) * (to - from));
  }
  return out;
}

/// A flat face in the world.
struct Seen {
  Vec3 n_W;
  double offset_m = 0;
  Box box_W;
  const FlatFace* face;
  const PlacedSurface* part;

  [[nodiscard]] double above(const Vec3& p_W) const { return n_W.dot(p_W) - offset_m; }
};

Seen seen(const FlatFace& face, const PlacedSurface& part) {
  Seen out{part.X_WP.R * face.n, 0, {}, &face, &part};
  out.offset_m = face.offset_m + out.n_W.dot(part.X_WP.p);
  for (const std::uint32_t i : face.facets)
    for (const Vec3& p : part.surface->triangle(i)) out.box_W.add(part.X_WP * p);
  return out;
}

/// The facets of a face, projected along a key's normal.
struct FlatPatch {
  std::vector<std::array<Vec2, 3>> triangles;  // counter-clockwise
  std::vector<std::array<Vec2, 2>> boxes;
  Vec2 min = Vec2::Constant(1e300), max = Vec2::Constant(-1e300);
};

FlatPatch projected(const Seen& of, const Vec3& u, const Vec3& v) {
  FlatPatch flat;
  for (const std::uint32_t i : of.face->facets) {
    const Triangle t = of.part->surface->triangle(i);
    std::array<Vec2, 3> p;
    for (int k = 0; k < 3; ++k) {
      const Vec3 x = of.part->X_WP * t[k];
      p[k] = {u.dot(x), v.dot(x)};
    }
    if (twiceArea({p[0], p[1], p[2]}) < 0) std::swap(p[1], p[2]);
    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    flat.triangles.push_back(p);
    flat.boxes.push_back({low, high});
    flat.min = flat.min.cwiseMin(low);
    flat.max = flat.max.cwiseMax(high);
  }
  return flat;
}

/// The area in which two faces cover each other, as seen along their normal.
struct Facing {
  double area_m2 = 0;
  Vec2 min = Vec2::Constant(1e300), max = Vec2::Constant(-1e300);
};

Facing facing(const FlatPatch& a, const FlatPatch& b) {
  Facing out;
  if ((a.max.array() <= b.min.array()).any() || (b.max.array() <= a.min.array()).any()) return out;
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    if ((a.boxes[i][1].array() <= b.min.array()).any() || (b.max.array() <= a.boxes[i][0].array()).any())
      continue;
    for (std::size_t k = 0; k < b.triangles.size(); ++k) {
      if ((a.boxes[i][1].array() <= b.boxes[k][0].array()).any() ||
          (b.boxes[k][1].array() <= a.boxes[i][0].array()).any())
        continue;
      Polygon p(a.triangles[i].begin(), a.triangles[i].end());
      for (int e = 0; e < 3 && !p.empty(); ++e)
        p = clipped(p, b.triangles[k][e], b.triangles[k][(e + 1) % 3]);
      if (p.size() < 3) continue;
      out.area_m2 += 0.5 * twiceArea(p);
      for (const Vec2& x : p) {
        out.min = out.min.cwiseMin(x);
        out.max = out.max.cwiseMax(x);
      }
    }
  }
  return out;
}

/// A face of the key and the face of the slot opposite it.
struct Contact {
  Seen key, slot;
  double gap_m = 0;
  [[nodiscard]] bool isOpposite(const Contact& other) const {
    return key.n_W.dot(other.key.n_W) < 0 && key.n_W.cross(other.key.n_W).norm() < kKeyFitsParallel;
  }
};

std::vector<Contact> contacts(const FittedPart& key, const FittedPart& slot, double most_m) {
  std::vector<Seen> of_slot;
  for (const FlatFace& face : slot.faces.flat) of_slot.push_back(seen(face, slot.part));
  std::vector<Contact> out;
  for (const FlatFace& face : key.faces.flat) {
    const Seen of_key = seen(face, key.part);
    for (const Seen& other : of_slot) {
      if (of_key.n_W.dot(other.n_W) > 0 || of_key.n_W.cross(other.n_W).norm() > kKeyFitsParallel) continue;
      const double gap_m = other.above(of_key.box_W.center());
      if (std::abs(gap_m) <= most_m && distance2(of_key.box_W, other.box_W) <= 1.01 * gap_m * gap_m + 1e-18)
        out.push_back({of_key, other, gap_m});
    }
  }
  return out;
}

/// The direction, in the plane of a face, of the smallest rectangle around the face. One side of this
/// rectangle is parallel to an edge of the face.
Vec3 alongOf(const Seen& of) {
  // A face with more facets has a curved outline, for which any direction serves.
  constexpr std::size_t kFacets = 64;
  Vec3 best = of.n_W.unitOrthogonal();
  double least_m2 = 1e300;
  const auto& facets = of.face->facets;
  for (std::size_t i = 0; i < std::min(kFacets, facets.size()); ++i) {
    const Triangle t = of.part->surface->triangle(facets[i]);
    for (int e = 0; e < 3; ++e) {
      const Vec3 u = (of.part->X_WP.R * (t[(e + 1) % 3] - t[e])).normalized();
      const FlatPatch flat = projected(of, u, of.n_W.cross(u));
      const double area_m2 = (flat.max - flat.min).prod();
      if (area_m2 >= least_m2 * (1 - 1e-9)) continue;
      least_m2 = area_m2;
      best = u;
    }
  }
  return best;
}

bool fitOf(const Contact& one, const Contact& two, CheckedFit& fit) {
  const double key_m = -two.key.above(one.key.box_W.center()), clearance_m = one.gap_m + two.gap_m;
  if (!(key_m > 0) || std::abs(clearance_m) > mostClearance_m(key_m)) return false;
  const Vec3 n = one.key.n_W, u = alongOf(one.key), v = n.cross(u);
  const Facing on_one = facing(projected(one.key, u, v), projected(one.slot, u, v)),
               on_two = facing(projected(two.key, u, v), projected(two.slot, u, v));
  const auto covers = [](const Facing& f, const Contact& c) {
    return f.area_m2 > kLeastFacing * std::min(c.key.face->area_m2, c.slot.face->area_m2);
  };
  if (!covers(on_one, one) || !covers(on_two, two)) return false;
  const Vec2 middle = 0.25 * (on_one.min + on_one.max + on_two.min + on_two.max);
  fit.kind = FitKind::Key;
  fit.axis_W = n;
  fit.at_W = middle.x() * u + middle.y() * v + (n.dot(one.key.box_W.center()) - 0.5 * key_m) * n;
  fit.shaft_m = key_m;
  fit.bore_m = key_m + clearance_m;
  const Vec2 sides_m = on_one.max - on_one.min;
  fit.along_W = sides_m.x() > sides_m.y() ? u : v;
  fit.length_m = sides_m.maxCoeff();
  fit.diametral_clearance_m = clearance_m;
  const double corners_m = one.key.box_W.min.norm() + one.key.box_W.max.norm();
  fit.error_m = 1e-15 * corners_m;
  for (const Seen* face : {&one.key, &one.slot, &two.key, &two.slot}) fit.error_m += face->face->residual_m;
  fit.iso_286 = isoFit(fit.bore_m, key_m);
  return true;
}

/// Faces that cracks or grooves divide give the same fit more than once; the longest fit is kept.
void addKeyOnce(const CheckedFit& fit, std::size_t first, std::vector<CheckedFit>& out) {
  for (std::size_t i = first; i < out.size(); ++i) {
    CheckedFit& other = out[i];
    const double same_m = 1e-5 * fit.shaft_m + fit.error_m + other.error_m;
    const bool is_same = std::abs(other.shaft_m - fit.shaft_m) <= same_m &&
                         std::abs(other.bore_m - fit.bore_m) <= same_m &&
                         std::abs(fit.axis_W.dot(fit.at_W - other.at_W)) <= same_m &&
                         fit.axis_W.cross(other.axis_W).norm() < kKeyFitsParallel;
    if (!is_same) continue;
    if (fit.length_m > other.length_m) other = fit;
    return;
  }
  out.push_back(fit);
}

void appendFits(const FittedPart& key, const FittedPart& slot, std::vector<CheckedFit>& out) {
  const double most_m = mostClearance_m(key.part.surface->box().size().maxCoeff());
  const std::vector<Contact> near = contacts(key, slot, most_m);
  const std::size_t first = out.size();
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t k = i + 1; k < near.size(); ++k) {
      if (!near[i].isOpposite(near[k])) continue;
      // Of the two opposite normals, the fit's axis is the one whose greatest component is positive.
      int greatest = 0;
      near[i].key.n_W.cwiseAbs().maxCoeff(&greatest);
      const bool is_first = near[i].key.n_W[greatest] > 0;
      CheckedFit fit;
      fit.shaft = key.part.name;
      fit.bore = slot.part.name;
      if (fitOf(near[is_first ? i : k], near[is_first ? k : i], fit)) addKeyOnce(fit, first, out);
    }
}

}  // namespace

FitFaces fitFaces(const PartSurface& surface) {
  constexpr std::size_t kFlat = 400;  // assumed: more than the flat faces of a machined part
  FitFaces faces{surface.round(), {}, {}};
  faces.threads = threadFaces(surface, faces.round);
  faces.flat = flatFaces(surface, faces.round, faces.threads, kFlat);
  return faces;
}

void appendKeyFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out) {
  appendFits(a, b, out);
  appendFits(b, a, out);
}

}  // namespace vps::scenes
