// SPDX-License-Identifier: BSD-3-Clause
// The normal of a helicoid z = lead phi / 2 pi + f(r) has n_phi / n_z = -lead / (2 pi r), whatever its
// profile. Each facet of a thread around an axis therefore gives the lead of the thread; facets of one thread
// agree on the lead, other facets do not. The surface's radius along the helix then confirms the thread.
#include "fits/faces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>

#include "scene/thread_form.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

struct Line {
  Vec3 p = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
};

/// A facet in cylindrical coordinates around an axis.
struct Flank {
  std::uint32_t facet = 0;
  double lead_m = 0;
  double radius_m = 0, along_m = 0, turn = 0;  // coordinates of the facet's middle; `turn` is 0 to 1
  double area_m2 = 0;
};

// Least |n . axis| of a flank's normal, which is at most 81 degrees from the axis.
constexpr double kLeastSlope = 0.15;
constexpr double kLeastFlank = 0.05;  // least radial part of a flank's normal

/// A facet, with data that do not depend on an axis.
struct Facet {
  std::uint32_t number = 0;
  Vec3 n = Vec3::Zero(), middle = Vec3::Zero();
  double area_m2 = 0;
};

/// The facets of a surface, and for each direction of an axis the facets whose normals allow them to be
/// flanks. A plate with holes has many axes of one direction, and most of its facets are flat or plain walls,
/// which the list for a direction leaves out.
class FlankFacets {
 public:
  explicit FlankFacets(const PartSurface& surface) {
    all_.reserve(surface.mesh().triangles.size());
    for (std::uint32_t i = 0; i < surface.mesh().triangles.size(); ++i) {
      const Triangle t = surface.triangle(i);
      all_.push_back(
          {i, surface.normal(i), (t[0] + t[1] + t[2]) / 3, 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm()});
    }
  }

  /// All facets whose normals meet the demands of flanksAround(), and possibly a few more.
  const std::vector<Facet>& along(const Vec3& axis) {
    constexpr double kSameWay = 1 - 1e-6;  // least cosine of equal directions (1.4 mrad apart)
    constexpr double kMargin = 2e-3;       // margin of slope and facing for directions that are merged
    for (const Direction& known : directions_)
      if (std::abs(axis.dot(known.axis)) > kSameWay) return known.facets;
    Direction& direction = directions_.emplace_back();
    direction.axis = axis;
    for (const Facet& facet : all_) {
      const double slope = facet.n.dot(axis);
      if (std::abs(slope) >= kLeastSlope - kMargin &&
          (facet.n - slope * axis).norm() >= kLeastFlank - kMargin)
        direction.facets.push_back(facet);
    }
    return direction.facets;
  }

 private:
  struct Direction {
    Vec3 axis;
    std::vector<Facet> facets;
  };
  std::vector<Facet> all_;
  std::deque<Direction> directions_;
};

/// Facets that can be flanks of an external or internal thread around the axis.
std::vector<Flank> flanksAround(FlankFacets& facets, const Line& line, bool is_inside) {
  constexpr double kLeastLead = 0.002, kMostLead = 1;  // lead divided by 2 pi r
  const Vec3 x = line.axis.unitOrthogonal(), y = line.axis.cross(x);
  std::vector<Flank> out;
  StridedPoll poll;
  for (const Facet& facet : facets.along(line.axis)) {
    poll();
    const double slope = facet.n.dot(line.axis);
    if (std::abs(slope) < kLeastSlope) continue;
    const Vec3 c = facet.middle - line.p;
    const Vec3 r = c - line.axis.dot(c) * line.axis;
    const double radius_m = r.norm();
    if (!(radius_m > 0)) continue;
    const double facing = facet.n.dot(r) / radius_m * (is_inside ? -1 : 1);
    if (facing < kLeastFlank) continue;
    const double lead_m = -kTurn_rad * facet.n.dot(line.axis.cross(r)) / slope;
    if (std::abs(lead_m) < kLeastLead * kTurn_rad * radius_m ||
        std::abs(lead_m) > kMostLead * kTurn_rad * radius_m)
      continue;
    const double turn = std::atan2(r.dot(y), r.dot(x)) / kTurn_rad;
    out.push_back({facet.number, lead_m, radius_m, line.axis.dot(c), turn - std::floor(turn), facet.area_m2});
  }
  return out;
}

/// The flanks of one hand (right or left) whose lead agrees with the lead that has the largest area.
std::vector<Flank> agreeing(const std::vector<Flank>& flanks) {
  constexpr double kBin = 0.05;  // width of a bin of the lead's logarithm
  constexpr int kReach = 3;      // bins to each side, since the leads of coarse facets scatter
  std::map<std::pair<bool, int>, double> area_m2;
  std::vector<std::pair<bool, int>> bins;
  bins.reserve(flanks.size());
  for (const Flank& flank : flanks) {
    bins.emplace_back(flank.lead_m < 0,
                      static_cast<int>(std::floor(std::log(std::abs(flank.lead_m)) / kBin)));
    area_m2[bins.back()] += flank.area_m2;
  }
  std::pair<bool, int> best;
  double most_m2 = 0;
  for (const auto& [bin, own_m2] : area_m2) {
    double sum_m2 = 0;
    for (int i = -kReach; i <= kReach; ++i)
      if (const auto near = area_m2.find({bin.first, bin.second + i}); near != area_m2.end())
        sum_m2 += near->second;
    if (sum_m2 > most_m2) most_m2 = sum_m2, best = bin;
  }
  std::vector<Flank> out;
  for (std::size_t i = 0; i < flanks.size(); ++i)
    if (bins[i].first == best.first && std::abs(bins[i].second - best.second) <= kReach)
      out.push_back(flanks[i]);
  return out;
}

/// Removes the flanks that are much nearer to the axis, or farther from it, than the median flank.
void keepOneRadius(std::vector<Flank>& flanks) {
  constexpr double kNear = 1.5;
  std::ranges::sort(flanks, {}, &Flank::radius_m);
  double half_m2 = 0;
  for (const Flank& flank : flanks) half_m2 += 0.5 * flank.area_m2;
  double median_m = 0;
  for (const Flank& flank : flanks) {
    if (half_m2 <= 0) break;
    half_m2 -= flank.area_m2;
    median_m = flank.radius_m;
  }
  std::erase_if(flanks, [&](const Flank& flank) {
    return flank.radius_m > kNear * median_m || flank.radius_m < median_m / kNear;
  });
}

bool goAllAround(const std::vector<Flank>& flanks) {
  constexpr std::size_t kParts = 12;
  constexpr double kLeastTurns = 1.2;  // least turns between the middles of the first and last facets
  // Least share of the flanks' cylinder that the flanks cover. A metric thread covers half of its cylinder.
  // The chamfers of a plate's many holes lie all around each hole and cover a few hundredths.
  constexpr double kLeastCovered = 0.05;
  std::array<bool, kParts> is_there = {};
  double from_m = 1e300, to_m = -1e300, least_m = 1e300, area_m2 = 0;
  for (const Flank& flank : flanks) {
    is_there[std::min(kParts - 1, static_cast<std::size_t>(flank.turn * kParts))] = true;
    from_m = std::min(from_m, flank.along_m);
    to_m = std::max(to_m, flank.along_m);
    least_m = std::min(least_m, flank.radius_m);
    area_m2 += flank.area_m2;
  }
  return !flanks.empty() && std::ranges::all_of(is_there, [](bool is) { return is; }) &&
         to_m - from_m > kLeastTurns * std::abs(flanks.front().lead_m) &&
         area_m2 > kLeastCovered * kTurn_rad * least_m * (to_m - from_m);
}

/// The facets of the thread: they lie between the ends and radii of the flanks and face the same side.
std::vector<std::uint32_t> aroundFlanks(const PartSurface& surface, const Line& line,
                                        const std::vector<Flank>& flanks, bool is_inside) {
  double from_m = 1e300, to_m = -1e300, least_m = 1e300, greatest_m = 0;
  for (const Flank& flank : flanks)
    for (const Vec3& corner : surface.triangle(flank.facet)) {
      const Vec3 r = corner - line.p;
      const double along_m = line.axis.dot(r), radius_m = (r - along_m * line.axis).norm();
      from_m = std::min(from_m, along_m);
      to_m = std::max(to_m, along_m);
      least_m = std::min(least_m, radius_m);
      greatest_m = std::max(greatest_m, radius_m);
    }
  std::vector<std::uint32_t> out;
  StridedPoll poll;
  for (std::uint32_t i = 0; i < surface.mesh().triangles.size(); ++i) {
    poll();
    const Triangle t = surface.triangle(i);
    const Vec3 c = (t[0] + t[1] + t[2]) / 3 - line.p;
    const double along_m = line.axis.dot(c);
    const Vec3 r = c - along_m * line.axis;
    if (along_m < from_m || along_m > to_m || r.norm() < 0.9 * least_m || r.norm() > 1.1 * greatest_m)
      continue;
    if (surface.normal(i).dot(r) * (is_inside ? -1 : 1) > 0) out.push_back(i);
  }
  return out;
}

/// A mesh of some facets; each facet has corners of its own.
Mesh meshOf(const PartSurface& surface, const std::vector<std::uint32_t>& facets) {
  Mesh out;
  for (const std::uint32_t i : facets) {
    const Triangle t = surface.triangle(i);
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.insert(out.vertices.end(), t.begin(), t.end());
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

/// A corner in cylindrical coordinates around the axis of a thread.
struct Corner {
  Vec3 at;
  double along_m = 0, radius_m = 0, turn = 0;
};

std::vector<Corner> cornersOf(const PartSurface& surface, const std::vector<Flank>& flanks,
                              const Line& line) {
  const Vec3 x = line.axis.unitOrthogonal(), y = line.axis.cross(x);
  std::vector<Corner> out;
  for (const Flank& flank : flanks)
    for (const Vec3& corner : surface.triangle(flank.facet)) {
      const Vec3 r = corner - line.p;
      const double turn = std::atan2(r.dot(y), r.dot(x)) / kTurn_rad;
      out.push_back({corner, line.axis.dot(r), std::hypot(r.dot(x), r.dot(y)), turn - std::floor(turn)});
    }
  return out;
}

/// The corner farthest from the axis in each sector of each turn, without half a turn at both ends. The
/// corners are points on the crests of a screw or the roots of a nut.
std::vector<Vec3> farthestCorners(const std::vector<Corner>& corners, double lead_m) {
  constexpr std::size_t kSectors = 12;
  double from_m = 1e300, to_m = -1e300;
  for (const Corner& corner : corners) {
    from_m = std::min(from_m, corner.along_m);
    to_m = std::max(to_m, corner.along_m);
  }
  from_m += 0.5 * lead_m;
  const auto turns = static_cast<std::size_t>(std::max(1.0, std::floor((to_m - from_m) / lead_m - 0.5)));
  std::vector<const Corner*> farthest(turns * kSectors, nullptr);
  for (const Corner& corner : corners) {
    const double row = std::floor((corner.along_m - from_m) / lead_m);
    if (row < 0 || row >= double(turns)) continue;
    const auto sector = std::min(kSectors - 1, static_cast<std::size_t>(corner.turn * double(kSectors)));
    const Corner*& best = farthest[static_cast<std::size_t>(row) * kSectors + sector];
    if (best == nullptr || corner.radius_m > best->radius_m) best = &corner;
  }
  std::vector<Vec3> out;
  for (const Corner* corner : farthest)
    if (corner != nullptr) out.push_back(corner->at);
  return out;
}

/// Measures axis, radii and ends of a thread by a cylinder through its crests or roots; points at chamfered
/// ends are left out.
bool measure(const PartSurface& surface, const std::vector<Flank>& flanks, ThreadFace& face) {
  constexpr int kRounds = 4;           // number of rounds; a better axis finds better crests
  constexpr double kChamfered = 0.15;  // share of the thread's depth below the crests
  Cylinder crests{face.axis, face.p, 0};
  double depth_m = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Corner> corners = cornersOf(surface, flanks, {crests.p, crests.axis});
    const auto [least, greatest] = std::ranges::minmax(corners, {}, &Corner::radius_m);
    depth_m = greatest.radius_m - least.radius_m;
    std::vector<Vec3> points = farthestCorners(corners, std::abs(flanks.front().lead_m));
    if (round == 0) crests.radius_m = greatest.radius_m;
    std::erase_if(points, [&](const Vec3& p) { return round > 0 && crests.off(p) < -kChamfered * depth_m; });
    if (!fitCylinder(points, crests)) return false;
    face.residual_m = 0;
    for (const Vec3& p : points) face.residual_m = std::max(face.residual_m, std::abs(crests.off(p)));
  }
  face.axis = crests.axis;
  face.p = crests.p;
  face.greatest_m = crests.radius_m;
  face.from_m = face.least_m = 1e300;
  face.to_m = -1e300;
  for (const Corner& corner : cornersOf(surface, flanks, {face.p, face.axis})) {
    face.from_m = std::min(face.from_m, corner.along_m);
    face.to_m = std::max(face.to_m, corner.along_m);
    face.least_m = std::min(face.least_m, corner.radius_m);
  }
  return true;
}

std::vector<Line> candidateAxes(const PartSurface& surface, const std::vector<RoundFace>& round) {
  std::vector<Line> lines;
  const double same_m = 1e-3 * surface.box().size().norm();
  const auto add = [&](const Line& line) {
    const bool is_new = std::ranges::none_of(lines, [&](const Line& other) {
      const Vec3 r = line.p - other.p;
      return std::abs(line.axis.dot(other.axis)) > 1 - 1e-6 &&
             (r - other.axis.dot(r) * other.axis).norm() < same_m;
    });
    if (is_new) lines.push_back(line);
  };
  std::vector<const RoundFace*> longest;
  for (const RoundFace& face : round) longest.push_back(&face);
  std::ranges::stable_sort(longest, std::greater<>(), [](const RoundFace* f) { return f->to_m - f->from_m; });
  for (const RoundFace* face : longest) add({face->p, face->axis});
  const MassProperties mass = massProperties(surface.mesh());
  if (!(mass.volume_m3 > 0) || !isWithin(mass.com, surface.box())) return lines;
  const auto addPrincipal = [&](const Mat3& tensor) {
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(tensor);
    for (int k = 0; k < 3; ++k) add({mass.com, principal.eigenvectors().col(k)});
  };
  addPrincipal(mass.inertia_m5);
  // A rod whose length is 0.87 times its width has the same inertia about all axes. The distribution of the
  // rod's normals still shows the axis.
  Mat3 facing_m2 = Mat3::Zero();
  for (std::uint32_t i = 0; i < surface.mesh().triangles.size(); ++i) {
    const Triangle t = surface.triangle(i);
    const Vec3 n = surface.normal(i);
    facing_m2 += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm() * n * n.transpose();
  }
  addPrincipal(facing_m2);
  return lines;
}

}  // namespace

std::vector<ThreadFace> threadFaces(const PartSurface& surface, const std::vector<RoundFace>& round) {
  std::vector<ThreadFace> out;
  FlankFacets facets(surface);
  for (const Line& line : candidateAxes(surface, round))
    for (const bool is_inside : {false, true}) {
      pollStop();
      std::vector<Flank> flanks = agreeing(flanksAround(facets, line, is_inside));
      keepOneRadius(flanks);
      if (!goAllAround(flanks)) continue;
      ThreadFace face;
      face.axis = line.axis;
      face.p = line.p;
      face.is_inside = is_inside;
      if (!measure(surface, flanks, face)) continue;
      face.facets = aroundFlanks(surface, {face.p, face.axis}, flanks, is_inside);
      const auto form = findThread(meshOf(surface, face.facets), face.p, face.axis, is_inside);
      if (!form || (form->lead_m < 0) != (flanks.front().lead_m < 0)) continue;
      face.lead_m = form->lead_m;
      face.starts = form->starts;
      const bool is_known = std::ranges::any_of(out, [&](const ThreadFace& other) {
        const Vec3 r = face.p - other.p;
        return other.is_inside == is_inside && std::abs(face.axis.dot(other.axis)) > 0.99 &&
               (r - other.axis.dot(r) * other.axis).norm() < 0.1 * other.greatest_m;
      });
      if (!is_known) out.push_back(face);
    }
  return out;
}

}  // namespace vps::scenes
