// SPDX-License-Identifier: BSD-3-Clause
#include "check/check_placed.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "surface/placed_surface.h"
#include "vps/box_intersection.h"
#include "vps/mesh_distance.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMost = 60;  // assumed: more pictures than a reader looks at

/// The unit vector that is perpendicular to a direction and nearest to an axis of the world.
Vec3 acrossOf(const Vec3& axis_W, const std::array<int, 3>& order = {0, 1, 2}) {
  Vec3 best = axis_W.unitOrthogonal();
  double most = 0;
  for (const int k : order) {
    const Vec3 across = Vec3::Unit(k) - axis_W[k] * axis_W;
    if (across.norm() <= most + 1e-6) continue;
    most = across.norm();
    best = across.normalized();
  }
  return best;
}

/// The section of a fit. A shaft is drawn upright or level, whichever is nearer to its direction in the
/// world; a key is seen along its length.
CheckedSection sectionOf(const CheckedFit& fit) {
  CheckedSection section;
  section.is_fit = true;
  section.at_W = fit.at_W;
  const double gap_m = std::abs(fit.diametral_clearance_m);
  section.near_m = {0.5 * fit.shaft_m, 0};
  section.near_half_m = std::max({2.5 * gap_m, 10 * fit.error_m, 1e-3 * fit.shaft_m});
  if (fit.kind == FitKind::Key) {
    section.right_W = fit.axis_W;
    section.up_W = fit.along_W.cross(fit.axis_W).normalized();
    section.half_m = 1.8 * fit.bore_m;
    return section;
  }
  section.half_m = std::max(1.1 * fit.bore_m, 0.65 * fit.length_m);
  section.up_W = fit.axis_W;
  section.right_W = acrossOf(fit.axis_W);
  if (std::abs(fit.axis_W.z()) < 0.7) {
    section.right_W = fit.axis_W;
    section.up_W = acrossOf(fit.axis_W, {2, 0, 1});
    std::swap(section.near_m[0], section.near_m[1]);
  }
  return section;
}

/// The direction from the deepest point to the nearest point of either surface, along which the depth of the
/// overlap is measured.
Vec3 depthDirection(const PlacedSurface& a, const PlacedSurface& b, const Vec3& at_W) {
  Vec3 nearest_W = Vec3::Zero();
  double least_m = 1e300, size_m = 0;
  std::vector<std::pair<double, Vec3>> found;
  for (const PlacedSurface* part : {&a, &b}) {
    const Vec3 p_P = part->X_WP.inverse() * at_W;
    double within_m = 1e300;
    Vec3 q_W = at_W;
    Box around;
    around.add(p_P);
    part->surface->tree().forEach(
        [&](const Box& box) { return distance2(box, around) < within_m * within_m; },
        [&](std::uint32_t i) {
          const Triangle t = part->surface->triangle(i);
          const Vec3 q = closestOnTriangle(p_P, t[0], t[1], t[2]).q;
          if ((q - p_P).norm() >= within_m) return;
          within_m = (q - p_P).norm();
          q_W = part->X_WP * q;
        });
    found.emplace_back(within_m, q_W);
    size_m = std::max(size_m, part->surface->box().size().norm());
  }
  // The deepest point often lies on one of the two surfaces, so that only the other surface gives the
  // direction.
  for (const auto& [distance_m, q_W] : found)
    if (distance_m > 1e-9 * size_m && distance_m < least_m) {
      least_m = distance_m;
      nearest_W = q_W - at_W;
    }
  return least_m < 1e300 ? Vec3(nearest_W.normalized()) : Vec3::UnitZ();
}

CheckedSection sectionOf(const CheckedPair& pair, const PlacedSurface& a, const PlacedSurface& b) {
  CheckedSection section;
  section.at_W = pair.at_W;
  const Vec3 depth_W = depthDirection(a, b, pair.at_W);
  const double smaller_m = std::min(a.box_W.size().maxCoeff(), b.box_W.size().maxCoeff());
  section.half_m = std::max(0.6 * smaller_m, 8 * pair.interference_depth_m);
  section.near_half_m = std::min(4 * pair.interference_depth_m, section.half_m);
  // The direction of the depth is drawn upright or level, whichever is nearer to its direction in the world.
  if (std::abs(depth_W.z()) > 0.7) {
    section.up_W = depth_W;
    section.right_W = acrossOf(depth_W);
  } else {
    section.right_W = depth_W;
    section.up_W = acrossOf(depth_W, {2, 0, 1});
  }
  // The deepest point often lies on a face. The plane is shifted a little towards the middle of the shared
  // box, so that it does not graze the face.
  constexpr double kInwards = 0.02;
  const Vec3 middle_W = intersection(a.box_W, b.box_W).center();
  const Vec3 n_W = section.right_W.cross(section.up_W);
  section.at_W += kInwards * n_W.dot(middle_W - pair.at_W) * n_W;
  return section;
}

/// True if the part may be in the picture.
bool isSeen(const PlacedSurface& part, const CheckedSection& section) {
  const Vec3 r = part.box_W.center() - section.at_W, half = 0.5 * part.box_W.size();
  const auto reaches = [&](const Vec3& d, double within_m) {
    return std::abs(d.dot(r)) <= d.cwiseAbs().dot(half) + within_m;
  };
  return reaches(section.right_W, section.half_m) && reaches(section.up_W, section.half_m) &&
         reaches(section.right_W.cross(section.up_W), 0);
}

}  // namespace

std::vector<CheckedSection> checkSections(const std::vector<PlacedSurface>& parts, const CheckResult& result,
                                          const Progress& progress) {
  std::vector<CheckedSection> sections;
  std::vector<std::array<const PlacedSurface*, 2>> concerned;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    const CheckedPair& pair = result.pairs[i];
    if (pair.state < PairState::PressFit || sections.size() == kMost) continue;
    const PlacedSurface &a = named(parts, pair.a), &b = named(parts, pair.b);
    sections.push_back(sectionOf(pair, a, b));
    sections.back().of = i;
    concerned.push_back({&a, &b});
  }
  std::vector<std::size_t> order(result.fits.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return result.fits[i].diametral_clearance_m; });
  for (const std::size_t i : order) {
    if (sections.size() == kMost) break;
    pollStop();
    sections.push_back(sectionOf(result.fits[i]));
    sections.back().of = i;
    concerned.push_back({&named(parts, result.fits[i].shaft), &named(parts, result.fits[i].bore)});
  }
  forEachOnCores(sections.size(), progress, "drawing sections", [&](std::size_t i) {
    CheckedSection& section = sections[i];
    for (const PlacedSurface* part : concerned[i]) section.parts.push_back(outlineOf(*part, section));
    for (const PlacedSurface& part : parts) {
      if (&part == concerned[i][0] || &part == concerned[i][1] || !isSeen(part, section)) continue;
      if (SectionOutline outline = outlineOf(part, section); !outline.chains.empty())
        section.parts.push_back(std::move(outline));
    }
  });
  return sections;
}

}  // namespace vps::scenes
