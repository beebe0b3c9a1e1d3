// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/refinement/curved_contact.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// Distance of a point from the triangle of a face. The nearest triangle is mostly this one or a neighbour, so
// the distance bounds the search of the mesh. The limit includes the search's own rounding, so that the
// result has the same bits as without the limit.
double distanceTo(const FacePoint& face, const Pose& X_WM, const Vec3& p_W) {
  const Mesh& mesh = face.surface->distance->mesh();
  const auto& t = mesh.triangles[face.triangle];
  const Vec3 p = (X_WM * face.surface->X_MP).inverse() * p_W;
  const Vec3 q = closestOnTriangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).q;
  return (1 + kRoundingShare) * (p - q).norm() + kRoundingShare * kSameGap_m;
}

// The face nearest to p; nothing if an edge or an open surface is nearer.
std::optional<FacePoint> nearestFace(const SideView& side, const Vec3& p_W, double max_m,
                                     const FacePoint* guess = nullptr) {
  std::optional<FacePoint> nearest;
  MeshDistance::Closest best;
  best.distance_m = guess ? std::min(max_m, distanceTo(*guess, side.X_WM, p_W)) : max_m;
  for (const Surface& surface : side.shape->models().surfaces) {
    const Pose X_WP = side.X_WM * surface.X_MP;
    const MeshDistance::Closest closest = surface.distance->closest(X_WP.inverse() * p_W, best.distance_m);
    if (!closest.found) continue;
    best = closest;
    nearest =
        FacePoint{X_WP * closest.q, X_WP.R * surface.distance->smoothNormal(closest.triangle, closest.q),
                  &surface, X_WP.R, closest.triangle};
  }
  if (!nearest) return {};
  const Vec3 face = nearest->surface->distance->featureNormal(nearest->triangle, 0);
  if (nearest->surface->sheet || face.dot(best.normal) < kCosSameFace) return {};
  return nearest;
}

/// Two orthonormal directions normal to n.
Eigen::Matrix<double, 3, 2> across(const Vec3& n) {
  Eigen::Matrix<double, 3, 2> T;
  T.col(0) = n.unitOrthogonal();
  T.col(1) = n.cross(T.col(0));
  return T;
}

double gapBetween_m(const FacePoint& own, const FacePoint& their) {
  return (own.q_W - their.q_W).dot(their.outward_W);
}

// Displacement in the tangent plane to the minimum of the gap's parabola; zero along directions in which the
// parabola is too flat to matter.
Vec3 wayToLeast(const FacePoint& own, const FacePoint& their, double reach_m) {
  const Eigen::Matrix<double, 3, 2> T = across(their.outward_W);
  const Eigen::Vector2d slope = T.transpose() * own.outward_W;
  const Eigen::Matrix2d K = T.transpose() * (own.curvature_W() + their.curvature_W()) * T;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(K);
  const double least_per_m = 2 * kSameGap_m / (reach_m * reach_m);
  Eigen::Vector2d way = Eigen::Vector2d::Zero();
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d along = eigen.eigenvectors().col(i);
    if (const double k = eigen.eigenvalues()[i]; k > least_per_m) way -= slope.dot(along) / k * along;
  }
  return T * way;
}

}  // namespace

FacePoint ownFace(const Candidate& c, const SideView& side) {
  const Shape::PointFace face = side.shape->faceAt(c.id);
  const Surface& surface = side.shape->models().surfaces[face.surface];
  return {c.p_W, -(side.X_WM.R * side.shape->smoothInward(c.id)), &surface, side.X_WM.R * surface.X_MP.R,
          face.triangle};
}

bool moveToNearest(Candidate& c, const SideView& side, const SideView& other, const FacePoint& foot,
                   double max_gain_m) {
  if (side.shape->models().surfaces.empty()) return false;  // its faces are not known
  const double reach_m = side.shape->models().shell->spacing_m;
  std::optional<FacePoint> own = ownFace(c, side), their = foot;
  if (own->surface->sheet || their->surface->sheet) return false;
  if (!((own->outward_W + their->outward_W).norm() * reach_m > kSameGap_m)) return false;
  FacePoint nearest[2] = {*own, *their};
  double nearest_m = gapBetween_m(*own, *their);
  for (int i = 0; i < kMostRetakes; ++i) {
    const Vec3 way = wayToLeast(*own, *their, reach_m);
    if (way.norm() < kNearestShare * reach_m) break;
    // Farther than the spacing another shell point is nearer to the place, and its candidate is moved there.
    const Vec3 to_W = own->q_W + way;
    if ((to_W - c.p_W).norm() > reach_m) return false;
    if (i == kMostRetakes - 1) {
      // The normals of a fan of facets are not known well enough at its hub to find the exact place.
      own = nearest[0];
      their = nearest[1];
      break;
    }
    const double gap_m = std::abs(gapBetween_m(*own, *their));
    own = nearestFace(side, to_W, way.norm(), &*own);
    if (own) their = nearestFace(other, own->q_W, gap_m + 2 * way.norm(), &*their);
    if (!own || !their || !(own->outward_W.dot(their->outward_W) < -kCosSameFace)) return false;
    if (const double now_m = gapBetween_m(*own, *their); now_m < nearest_m) {
      nearest_m = now_m;
      nearest[0] = *own;
      nearest[1] = *their;
    }
  }
  const double gap_m = gapBetween_m(*own, *their);
  if (c.distance_m - gap_m > max_gain_m) return false;
  c.p_W = own->q_W;
  c.n_W = (side.side == 0 ? 1 : -1) * their->outward_W;
  c.surface[1 - c.side] = static_cast<std::uint16_t>(their->surface - other.shape->models().surfaces.data());
  // A corner between facets may be nearer than the curved surface.
  c.distance_m = std::min(c.distance_m, gap_m);
  return true;
}

bool moveToFoot(Candidate& c, const SideView& side, const Vec3& from_q_W) {
  const Vec3 q_W = c.p_W - from_q_W;
  const std::optional<FacePoint> own = nearestFace(side, q_W, from_q_W.norm() + kSameGap_m);
  if (!own) return false;
  const Vec3 n_W = (side.side == 0 ? -1 : 1) * own->outward_W;
  if ((n_W - c.n_W).norm() * from_q_W.norm() < kSameGap_m) return false;  // the face is flat
  c.p_W = own->q_W;
  c.n_W = n_W;
  c.distance_m = (q_W - own->q_W).dot(own->outward_W);
  return true;
}

void moveToClosest(Candidate& c, const SideView& side, const Vec3& from_q_W) {
  const Vec3 q_W = c.p_W - from_q_W;
  Vec3 nearest_W = c.p_W;
  double distance_m = from_q_W.norm();
  for (const Surface& surface : side.shape->models().surfaces) {
    const Pose X_WP = side.X_WM * surface.X_MP;
    const MeshDistance::Closest closest = surface.distance->closest(X_WP.inverse() * q_W, distance_m);
    if (!closest.found) continue;
    nearest_W = X_WP * closest.q;
    distance_m = (nearest_W - q_W).norm();
  }
  if (distance_m < kSamePlace_m) return;
  c.p_W = nearest_W;
  c.n_W = (side.side == 0 ? 1 : -1) / distance_m * (nearest_W - q_W);
  c.distance_m = distance_m;
}

Curvature::Curvature(const Mat3& turn_per_m) {
  const double half = 0.5 * turn_per_m.trace();
  const double product = 0.5 * (4 * half * half - turn_per_m.squaredNorm());
  const double apart = std::sqrt(std::max(half * half - product, 0.0));
  most_per_m = half + apart;
  least_per_m = half - apart;
}

namespace {

// Greatest curvature of the face on which a candidate's point lies.
double ownCurvature_per_m(const PairView& pair, const Candidate& c) {
  const Shape* shape = pair.shape[c.side];
  if (c.isCrossing() || !shape || shape->models().surfaces.empty() || shape->isEdgePoint(c.id)) return 0;
  const Shape::PointFace face = shape->faceAt(c.id);
  if (!shape->features().isCurved(face.surface, face.triangle)) return 0;
  const Surface& surface = shape->models().surfaces[face.surface];
  return surface.sheet ? 0 : Curvature(surface.distance->smoothCurvature(face.triangle)).most_per_m;
}

}  // namespace

SamplingError::SamplingError(const PairView& pair, std::span<const Candidate> near) : pair_(pair) {
  for (const Candidate& c : near)
    most_per_m_[c.side] = std::max(most_per_m_[c.side], ownCurvature_per_m(pair, c));
}

double SamplingError::of_m(const Candidate& c) const {
  const Shape* shape = pair_.shape[c.side];
  if (c.isCrossing() || !shape || shape->isEdgePoint(c.id)) return 0;
  return samplingError_m(shape->models().shell->spacing_m,
                         std::max(ownCurvature_per_m(pair_, c), 0.0) + most_per_m_[1 - c.side]);
}

}  // namespace vps::bullet
