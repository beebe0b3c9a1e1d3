// SPDX-License-Identifier: BSD-3-Clause
#include "step/place_in_play.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "fits/fits.h"
#include "judge/body_motion.h"
#include "text/words.h"
#include "vps/box.h"
#include "vps/mesh.h"

namespace vps::scenes {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kMostTurn_rad = 0.2;  // assumed: a part that may turn by more is not held upright
constexpr double kNoMotion_m = 1e-6;   // displacements that move no point by more are left out
constexpr double kTouch_m = 0.5 * kContactOnBothSides_m;  // depth that counts as contact

/// The direction and the unit normal of the largest flat area across it. Without a direction, the normal of
/// the largest area is the first axis: for a round part that of a strip, which is perpendicular to its axis.
Mat3 axesOf(const Mesh& mesh, const Vec3& along) {
  constexpr double kSameNormal = 1e-6;  // squared distance of the normals of facets of one direction
  constexpr double kAcross = 0.1;       // cosine; the normals of other faces are not used
  constexpr std::size_t kMostNormals = 256;
  struct Face {
    Vec3 n;
    double area_m2;
  };
  std::vector<Face> faces;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    if (!(n.norm() > 0)) continue;
    const Vec3 unit = n.normalized();
    const auto known = std::ranges::find_if(faces, [&](const Face& face) {
      return std::min((face.n - unit).squaredNorm(), (face.n + unit).squaredNorm()) < kSameNormal;
    });
    if (known != faces.end())
      known->area_m2 += n.norm();
    else if (faces.size() < kMostNormals)
      faces.push_back({unit, n.norm()});
  }
  if (faces.empty()) faces.push_back({Vec3::UnitZ(), 0});
  std::ranges::stable_sort(faces, std::greater<>(), &Face::area_m2);
  const Vec3 first = along.isZero() ? faces.front().n : along;
  Vec3 second = first.unitOrthogonal();
  for (const Face& face : faces) {
    if (std::abs(face.n.dot(first)) > kAcross) continue;
    second = (face.n - first * first.dot(face.n)).normalized();
    break;
  }
  Mat3 axes;
  axes << first, second, first.cross(second);
  return axes;
}

/// The pose of a part after a displacement of center_W by t and a turn by the rotation vector r about it.
Pose displacedBy(const Pose& X_WP, const Vec3& center_W, const Vec3& t, const Vec3& r) {
  const Mat3 R = rotationFromVector(r);
  return Pose(Mat3(R * X_WP.R), Vec3(center_W + t + R * (X_WP.p - center_W)));
}

bool isBall(const Solid& solid, const Vec3& center_P) {
  return std::ranges::all_of(std::array{0, 1, 2}, [&](int axis) {
    const Pose X = displacedBy(Pose(), center_P, Vec3::Zero(), kMostTurn_rad * Vec3::Unit(axis));
    return surfaceError_m(solid, X) <= kContactOnBothSides_m;
  });
}

/// See placeInPlay(): the point about which a part at its target turns.
Vec3 turningPoint(const OverlapJudge& judge, const Solid& solid, const Pose& X_WP) {
  const Box box_P = bounds(solid.mesh());
  const Vec3 com_P = solid.mass().com;
  const Vec3 center_P = isWithin(com_P, box_P) ? com_P : box_P.center();
  if (isBall(solid, center_P)) return X_WP * center_P;
  const Box near_W = grown(moved(box_P, X_WP), kSightTolerance_m);
  Box shared_W;
  for (const OverlapJudge::Mounted& other : judge.mounted()) {
    if (!other.body.model || !other.body.model->solid) continue;
    const Box other_W = moved(bounds(other.body.model->solid->mesh()), other.X_WB);
    const Vec3 low = near_W.min.cwiseMax(other_W.min), high = near_W.max.cwiseMin(other_W.max);
    if ((low.array() > high.array()).any()) continue;
    shared_W.add(low);
    shared_W.add(high);
  }
  return shared_W.isEmpty() ? Vec3(X_WP * center_P) : shared_W.center();
}

/// The greatest s from 0 on for which isDeep(s) is false; infinite if it comes to `most`. Steps double, so
/// that a thin wall near the target is not passed.
template <class IsDeep>
double freeUpTo(double most, const IsDeep& isDeep) {
  constexpr int kDoublings = 5, kHalvings = 9;
  double low = 0;
  for (int i = kDoublings; i >= 0; --i) {
    double high = std::ldexp(most, -i);
    if (!isDeep(high)) {
      low = high;
      continue;
    }
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      (isDeep(middle) ? high : low) = middle;
    }
    return low;
  }
  return kForever;
}

/// The pose of a part that is displaced from its target by of(room) along or about each axis.
template <class Of>
Pose poseOf(const PlaceInPlay& place, const Pose& X_WP_target, const Of& of) {
  Vec3 t = Vec3::Zero(), r = Vec3::Zero();
  for (const AxisRoom& room : place.rooms) (room.is_turn ? r : t) += of(room) * room.axis_W;
  return displacedBy(X_WP_target, place.center_W, t, r);
}

std::string axisInWords(const Vec3& axis_W) {
  constexpr double kEqual = 0.99999;
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis_W[i]) > kEqual) return std::string(1, "xyz"[i]);
  char words[64];
  std::snprintf(words, sizeof words, "(%.2f %.2f %.2f)", axis_W.x(), axis_W.y(), axis_W.z());
  return words;
}

/// An angle of fractions of a degree: "0.14 degrees"
std::string finelyInWords(double angle_rad) {
  char words[32];
  std::snprintf(words, sizeof words, "%.2f degrees", angle_rad * 180 / std::numbers::pi);
  return words;
}

}  // namespace

bool PlaceInPlay::isPlaced(double tolerance_m) const {
  return outside_m <= tolerance_m && outside_with_free_m <= std::max(tolerance_m, kSightTolerance_m);
}

PlaceInPlay placeInPlay(const OverlapJudge& judge, const JudgedBody& body, const Pose& X_WP_target,
                        const Vec3& along_W, const Pose& X_WP, double limit_m) {
  const Solid& solid = *body.model->solid;
  PlaceInPlay place;
  place.center_W = turningPoint(judge, solid, X_WP_target);
  const Mat3 axes_W = X_WP_target.R * axesOf(solid.mesh(), X_WP_target.R.transpose() * along_W);
  const Vec3 t = X_WP * (X_WP_target.inverse() * place.center_W) - place.center_W;
  const Vec3 r = rotationVector(X_WP.R * X_WP_target.R.transpose());
  const double reach_m = bounds(solid.mesh()).size().norm();
  limit_m = std::max(limit_m, judge.deepest(body, X_WP_target).depth_m);
  const auto isDeep = [&](const Pose& X) { return judge.deepest(body, X).depth_m > limit_m; };
  for (int i = 0; i < 6; ++i) {
    AxisRoom& room = place.rooms[i];
    room.is_turn = i >= 3;
    room.axis_W = axes_W.col(i % 3);
    room.off = room.axis_W.dot(room.is_turn ? r : t);
    if (std::abs(room.off) * (room.is_turn ? reach_m : 1) <= kNoMotion_m) continue;
    for (const int side : {0, 1})
      room.way[side] = freeUpTo(room.is_turn ? kMostTurn_rad : kSightTolerance_m, [&](double s) {
        const Vec3 by = (2 * side - 1) * s * room.axis_W, none = Vec3::Zero();
        return isDeep(
            displacedBy(X_WP_target, place.center_W, room.is_turn ? none : by, room.is_turn ? by : none));
      });
  }
  const double share = freeUpTo(1, [&](double s) {
    return isDeep(
        poseOf(place, X_WP_target, [&](const AxisRoom& room) { return room.isHeld() ? s * room.off : 0; }));
  });
  place.free_share = std::min(1.0, share);
  const auto errorOf = [&](const auto& of) {
    return surfaceError_m(solid, X_WP_target.inverse() * poseOf(place, X_WP_target, of));
  };
  place.outside_m = errorOf([&](const AxisRoom& room) { return room.isFree() ? 0 : place.outside(room); });
  place.outside_with_free_m = errorOf([&](const AxisRoom& room) { return place.outside(room); });
  return place;
}

bool movedWithinPlay(const OverlapJudge& judge, const JudgedBody& body, const Pose& X_WP_target,
                     const Vec3& along_W, const Pose& X_WP_from, const Pose& X_WP_to, double limit_m) {
  const PlaceInPlay from = placeInPlay(judge, body, X_WP_target, along_W, X_WP_from, limit_m);
  const PlaceInPlay to = placeInPlay(judge, body, X_WP_target, along_W, X_WP_to, limit_m);
  const auto restOf = [&](const PlaceInPlay& place) {
    return poseOf(place, X_WP_target, [&](const AxisRoom& room) { return place.outside(room); });
  };
  const Pose X_from = restOf(from), X_to = restOf(to);
  const Vec3 center_P = X_WP_target.inverse() * to.center_W;
  const Vec3 moved_m = X_to * center_P - X_from * center_P;
  const Pose X_turn =
      displacedBy(Pose(), center_P, Vec3::Zero(), rotationVector(X_from.R.transpose() * X_to.R));
  return moved_m.norm() <= kTouch_m && surfaceError_m(*body.model->solid, X_turn) <= kContactOnBothSides_m;
}

std::string inWords(const PlaceInPlay& place) {
  constexpr double kLeastTurn_rad = 1e-3;
  std::string words;
  for (const AxisRoom& room : place.rooms) {
    if (std::abs(room.off) <= (room.is_turn ? kLeastTurn_rad : kTouch_m)) continue;
    const auto amount = [&](double a) {
      std::string text = a < 0 ? "-" : "";
      text += room.is_turn ? finelyInWords(std::abs(a)) : lengthInWords(std::abs(a));
      return text;
    };
    words += (words.empty() ? "off by " : "; off by ") + amount(room.off) +
             (room.is_turn ? " about " : " along ") + axisInWords(room.axis_W);
    if (room.isFree())
      words += ", where nothing stops it";
    else if (room.isHeld())
      words += ", where its play is " + amount(-room.way[0]) + " to " + amount(room.way[1]);
    else
      words += ", where it is stopped on one side only";
  }
  return words;
}

}  // namespace vps::scenes
