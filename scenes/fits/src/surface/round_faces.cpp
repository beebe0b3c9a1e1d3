// SPDX-License-Identifier: BSD-3-Clause
#include "surface/round_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "surface/part_surface.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

/// Coordinates in files with six or seven digits deviate by up to 1e-6 of the greatest coordinate.
constexpr double kRoundFacesRounding = 2e-6;
/// Relative deviation of corners from a circle in coarse files: 1 um at a radius of 4 mm, for coordinates in
/// metres with six decimals.
constexpr double kCoarse = 2.5e-4;
constexpr double kLeastTurn = 0.3;
constexpr std::size_t kPatch = 16;  // number of facets from which a cylinder is guessed
/// Number of flat strips that determine a circle; one strip may be divided into many facets.
constexpr std::size_t kLeastNormals = 4;
/// Greatest depth of a facet's middle below the cylinder, divided by the radius: 1 - cos(kCurved_rad / 2).
constexpr double kMostChord = 0.02;

class Finder {
 public:
  explicit Finder(const PartSurface& surface)
      : surface_(surface),
        mesh_(surface.mesh()),
        is_taken_(mesh_.triangles.size()),
        is_tried_(is_taken_.size()),
        seen_(is_taken_.size()) {
    for (const Vec3& v : mesh_.vertices) tolerance_m_ = std::max(tolerance_m_, v.cwiseAbs().maxCoeff());
    tolerance_m_ *= kRoundFacesRounding;
    is_corner_.assign(mesh_.vertices.size(), false);
    for (std::uint32_t i = 0; i < is_taken_.size(); ++i)
      for (int e = 0; e < 3; ++e)
        if (isBent(i, surface_.neighbours()[i][e]))
          for (const int end : {e, (e + 1) % 3}) is_corner_[mesh_.triangles[i][end]] = true;
  }

  std::vector<RoundFace> find() {
    std::vector<RoundFace> faces;
    for (std::uint32_t seed = 0; seed < is_taken_.size(); ++seed) {
      if (is_taken_[seed] || is_tried_[seed] || !isBent(seed)) continue;
      pollStop();
      if (std::optional<RoundFace> face = grownFrom(seed)) faces.push_back(std::move(*face));
    }
    return faces;
  }

 private:
  [[nodiscard]] double turn(std::uint32_t i, std::uint32_t k) const {
    const Vec3 a = surface_.normal(i), b = surface_.normal(k);
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }
  [[nodiscard]] bool isBent(std::uint32_t i, std::uint32_t neighbour) const {
    const double turn_rad = neighbour == kNoFacet ? 0 : turn(i, neighbour);
    return turn_rad > 1e-4 && turn_rad < kCurved_rad;
  }
  [[nodiscard]] bool isBent(std::uint32_t i) const {
    return std::ranges::any_of(surface_.neighbours()[i], [&](std::uint32_t k) { return isBent(i, k); });
  }

  /// Calls visit(x) for the corners of a facet that lie on the true surface. If a flat strip of the cylinder
  /// was divided further, the additional corners lie on the strip, inside the cylinder, and are skipped.
  template <class Visit>
  void forEachCorner(std::uint32_t i, Visit visit) const {
    for (const std::uint32_t v : mesh_.triangles[i])
      if (is_corner_[v]) visit(mesh_.vertices[v]);
  }

  /// Facets for which `accepts` is true and that are connected to the seed across smooth edges.
  template <class Accepts>
  std::vector<std::uint32_t> flood(std::uint32_t seed, std::size_t most, Accepts accepts) {
    ++round_;
    std::vector<std::uint32_t> found{seed};
    seen_[seed] = round_;
    StridedPoll poll;
    for (std::size_t next = 0; next < found.size() && found.size() < most; ++next, poll())
      for (const std::uint32_t k : surface_.neighbours()[found[next]]) {
        if (k == kNoFacet || seen_[k] == round_) continue;
        seen_[k] = round_;
        if (!is_taken_[k] && turn(found[next], k) < kCurved_rad && accepts(k)) found.push_back(k);
      }
    return found;
  }

  std::optional<RoundFace> grownFrom(std::uint32_t seed) {
    std::vector<std::uint32_t> facets;
    for (const std::size_t most : {kPatch, 8 * kPatch, 64 * kPatch}) {
      facets = flood(seed, most, [](std::uint32_t) { return true; });
      if (differentNormals(facets) >= kLeastNormals) break;
    }
    std::optional<Cylinder> guess = guessed(facets);
    if (!guess) return std::nullopt;
    // In files with few digits, corners deviate more from the circle. The face's residual then shows the
    // deviation. The normals of uneven facets lean along the axis, so the axis of the guess may be wrong,
    // while their corners lie on the cylinder all the same.
    Cylinder refined = *guess;
    const bool is_refined = refine(refined, facets);
    for (const Cylinder* from : {&*guess, &refined})
      for (const double within_m : {tolerance_m_, kCoarse * guess->radius_m}) {
        if (from == &refined && !is_refined) continue;
        if (std::optional<RoundFace> face = grown(seed, *from, within_m)) return face;
      }
    return std::nullopt;
  }

  std::optional<RoundFace> grown(std::uint32_t seed, Cylinder guess, double within_m) {
    std::vector<std::uint32_t> facets;
    // The guess from a small patch is less precise than one from the whole face, so the first tolerance is
    // wider.
    for (const double loose_m : {1e-4 * guess.radius_m + 3 * within_m, within_m}) {
      const Cylinder& on = guess;
      const auto lies = [&](std::uint32_t i) { return liesOn(on, i, loose_m); };
      if (!lies(seed)) return std::nullopt;
      facets = flood(seed, is_taken_.size(), lies);
      if (facets.size() < 6 || !refine(guess, facets)) return std::nullopt;
    }
    std::erase_if(facets, [&](std::uint32_t i) { return !liesOn(guess, i, 2 * within_m); });
    return finished(guess, std::move(facets));
  }

  /// Number of distinct normals among the facets, up to kLeastNormals.
  [[nodiscard]] std::size_t differentNormals(const std::vector<std::uint32_t>& facets) const {
    std::vector<Vec3> normals;
    for (const std::uint32_t i : facets) {
      const Vec3 n = surface_.normal(i);
      const bool is_new = std::ranges::none_of(
          normals, [&](const Vec3& other) { return n.cross(other).squaredNorm() < 1e-8; });
      if (is_new) normals.push_back(n);
      if (normals.size() == kLeastNormals) break;
    }
    return normals.size();
  }

  [[nodiscard]] bool liesOn(const Cylinder& on, std::uint32_t i, double within_m) const {
    const Triangle t = surface_.triangle(i);
    const Vec3 n = surface_.normal(i), out = on.outward((t[0] + t[1] + t[2]) / 3);
    if (std::abs(n.dot(on.axis)) > 0.05 || std::abs(n.dot(out)) < 0.9 * out.norm()) return false;
    bool lies = true;
    forEachCorner(i, [&](const Vec3& x) { lies = lies && std::abs(on.off(x)) <= within_m; });
    return lies && std::ranges::all_of(t, [&](const Vec3& x) {
             return on.off(x) <= within_m && on.off(x) >= -kMostChord * on.radius_m - within_m;
           });
  }

  /// Guesses a cylinder: its normals are perpendicular to its axis, and its corners lie on a circle as seen
  /// along the axis.
  [[nodiscard]] std::optional<Cylinder> guessed(const std::vector<std::uint32_t>& facets) const {
    Mat3 spread = Mat3::Zero();
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t i : facets) {
      spread += surface_.normal(i) * surface_.normal(i).transpose();
      middle += surface_.triangle(i)[0];
    }
    middle /= static_cast<double>(facets.size());
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(spread);
    if (!(solver.eigenvalues()[0] < 1e-4 * solver.eigenvalues()[1])) return std::nullopt;
    Cylinder guess{solver.eigenvectors().col(0), middle, 0};
    // Least squares for x^2 + y^2 = 2 a x + 2 b y + c (Kasa 1976).
    const Vec3 u = guess.axis.unitOrthogonal(), v = guess.axis.cross(u);
    Mat3 sum = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    for (const std::uint32_t i : facets)
      forEachCorner(i, [&](const Vec3& x) {
        const Vec3 row(u.dot(x - middle), v.dot(x - middle), 1);
        sum += row * row.transpose();
        right += row * row.head<2>().squaredNorm();
      });
    const Vec3 solved = sum.ldlt().solve(right);
    const double x = 0.5 * solved.x(), y = 0.5 * solved.y();
    const double radius2_m2 = solved.z() + x * x + y * y;
    if (!std::isfinite(radius2_m2) || radius2_m2 <= 0) return std::nullopt;
    guess.p = middle + x * u + y * v;
    guess.radius_m = std::sqrt(radius2_m2);
    return guess;
  }

  bool refine(Cylinder& of, const std::vector<std::uint32_t>& facets) const {
    std::vector<Vec3> corners;
    for (const std::uint32_t i : facets) forEachCorner(i, [&](const Vec3& x) { corners.push_back(x); });
    return fitCylinder(corners, of);
  }

  std::optional<RoundFace> finished(const Cylinder& on, std::vector<std::uint32_t> facets) {
    RoundFace face{on.axis, on.p, on.radius_m, 1e300, -1e300, 0, false, std::move(facets)};
    double area_m2 = 0, facing = 0;
    for (const std::uint32_t i : face.facets) {
      const Triangle t = surface_.triangle(i);
      area_m2 += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
      facing += surface_.normal(i).dot(on.outward((t[0] + t[1] + t[2]) / 3));
      for (const Vec3& x : t) {
        const double along_m = on.axis.dot(x - on.p);
        face.from_m = std::min(face.from_m, along_m);
        face.to_m = std::max(face.to_m, along_m);
      }
      forEachCorner(i,
                    [&](const Vec3& x) { face.residual_m = std::max(face.residual_m, std::abs(on.off(x))); });
    }
    face.is_bore = facing < 0;
    const double whole_m2 = 2 * std::numbers::pi * on.radius_m * (face.to_m - face.from_m);
    if (!(area_m2 >= kLeastTurn * whole_m2) || !(whole_m2 > 0)) {
      for (const std::uint32_t i : face.facets) is_tried_[i] = true;
      return std::nullopt;
    }
    for (const std::uint32_t i : face.facets) is_taken_[i] = true;
    std::ranges::sort(face.facets);
    return face;
  }

  const PartSurface& surface_;
  const Mesh& mesh_;
  double tolerance_m_ = 0;
  std::vector<bool> is_taken_;
  // By facet: whether it lies on a cylinder that covers too small a share of a turn, as a thread's crest
  // does.
  std::vector<bool> is_tried_;
  std::vector<bool> is_corner_;  // by vertex: whether it lies on an edge between facets of a curved face
  std::vector<std::uint32_t> seen_;
  std::uint32_t round_ = 0;
};

}  // namespace

std::vector<RoundFace> roundFaces(const PartSurface& surface) {
  return Finder(surface).find();
}

bool fitCylinder(std::span<const Vec3> points, Cylinder& cylinder) {
  using Vec5 = Eigen::Matrix<double, 5, 1>;
  using Mat5 = Eigen::Matrix<double, 5, 5>;
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const Vec3 u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
    const double scale_m = cylinder.radius_m;  // factor that converts tilts to lengths
    Mat5 sum = Mat5::Zero();
    Vec5 right = Vec5::Zero();
    for (const Vec3& x : points) {
      const Vec3 out = cylinder.outward(x), r = out.normalized();
      const double along = cylinder.axis.dot(x - cylinder.p) / scale_m;
      Vec5 row;
      row << -r.dot(u), -r.dot(v), -along * r.dot(u), -along * r.dot(v), -1;
      sum += row * row.transpose();
      right -= row * (out.norm() - cylinder.radius_m);
    }
    const Vec5 step = sum.ldlt().solve(right);
    if (!step.allFinite() || step.norm() > cylinder.radius_m) return false;
    cylinder.p += step[0] * u + step[1] * v;
    cylinder.axis = (cylinder.axis + (step[2] * u + step[3] * v) / scale_m).normalized();
    cylinder.radius_m += step[4];
    if (step.norm() < 1e-13 * cylinder.radius_m) break;
  }
  return cylinder.radius_m > 0;
}

}  // namespace vps::scenes
