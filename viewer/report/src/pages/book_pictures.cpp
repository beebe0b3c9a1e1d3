// SPDX-License-Identifier: BSD-3-Clause
#include "pages/book_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pages/pictures.h"
#include "vps/box_intersection.h"

namespace vps::viewer {

BookSides sidesOf(const Vec3& up_W) {
  constexpr double kAlong = 0.9;
  const Vec3 across_W = std::abs(up_W.x()) < kAlong ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 right_W = (across_W - up_W.dot(across_W) * up_W).normalized();
  return {right_W, right_W.cross(up_W), up_W};
}

namespace {

constexpr double kBookMargin = 0.2;  // share of the picture that stays free for balloons

void addBox(Box& box, const Box& other) {
  if (other.isEmpty()) return;
  box.add(other.min);
  box.add(other.max);
}

/// The frame V of the view in W: x to the right, z up.
Pose viewFrame(const scenes::Book& book) {
  const BookSides sides = sidesOf(book.up_W);
  Mat3 R_WV;
  R_WV << sides.right_W, -sides.front_W, sides.up_W;
  return {R_WV, Vec3::Zero()};
}

/// Lets the camera show a box, which is given in V.
void frameBook(const Box& box_V, const Pose& X_WV, double aspect, BookPicture& picture) {
  Camera& camera = picture.camera;
  camera = frameScene(box_V, kToViewer, 0.5, aspect, kBookMargin);
  camera.eye_W = X_WV * camera.eye_W;
  camera.target_W = X_WV * camera.target_W;
  camera.up_W = X_WV.R.col(2);
  if (box_V.isEmpty()) return;
  for (const double x : {box_V.min.x(), box_V.max.x()})
    for (const double y : {box_V.min.y(), box_V.max.y()})
      for (const double z : {box_V.min.z(), box_V.max.z()})
        picture.corners_W.emplace_back(X_WV * Vec3(x, y, z));
}

/// A point on the part's surface for a balloon's line: on a facet that faces the eye, near the line from the
/// eye to the middle of the part, and near the eye. Other parts may hide the point.
Vec3 anchorOf(const Mesh& mesh, const Box& box_P, const Pose& X_WP, const Vec3& eye_W) {
  const Vec3 eye_P = X_WP.inverse() * eye_W, middle_P = box_P.center();
  const Vec3 to_eye_P = (eye_P - middle_P).normalized();
  Vec3 best_P = middle_P;
  double best_m = -std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    const Vec3 &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
               &c = mesh.vertices[triangle[2]];
    const Vec3 center_P = (a + b + c) / 3;
    if ((b - a).cross(c - a).dot(eye_P - center_P) <= 0) continue;
    const Vec3 from_middle = center_P - middle_P;
    const double near_m = from_middle.dot(to_eye_P);
    const double score_m = near_m - (from_middle - near_m * to_eye_P).norm();
    if (score_m <= best_m) continue;
    best_m = score_m;
    best_P = center_P;
  }
  return X_WP * best_P;
}

/// An arc about an axis through the middle of a box, on which the arrow of a turn lies.
std::vector<Vec3> turnArc(const Vec3& middle_W, const Vec3& size_m, const Vec3& axis_W, double turn_rad) {
  constexpr double kMost_rad = 1.5 * std::numbers::pi, kOutside = 0.4;
  constexpr int kPieces = 24;
  const double radius_m = kOutside * size_m.cwiseProduct(Vec3(Vec3::Ones() - axis_W.cwiseAbs())).norm();
  const Vec3 from_W = radius_m * axis_W.unitOrthogonal();
  std::vector<Vec3> arc;
  for (int i = 0; i <= kPieces; ++i)
    arc.emplace_back(middle_W +
                     rotationFromVector(std::min(turn_rad, kMost_rad) * i / kPieces * axis_W) * from_W);
  return arc;
}

/// The arrows of a step: along the path of the middle of its parts, and an arc for each turn.
std::vector<std::vector<Vec3>> arrowsOf(const scenes::BookStep& step, const Box& target_W) {
  constexpr double kLeast_rad = 0.02;
  const scenes::PlannedStep& planned = step.planned;
  const Vec3 middle_W = target_W.center();
  std::vector<std::vector<Vec3>> arrows(1);
  for (const Pose& before_W : planned.before_W) arrows.front().push_back(before_W * middle_W);
  arrows.front().push_back(middle_W);
  Vec3 at_W = arrows.front().front();
  if (planned.kind == scenes::WayKind::Screw && !planned.insertion_W.isZero()) {
    const Vec3 axis_W = (planned.lead_m < 0 ? -1 : 1) * planned.insertion_W.normalized();
    arrows.push_back(turnArc(at_W, target_W.size(), axis_W, 2 * std::numbers::pi));
  }
  for (const scenes::BookLeg& leg : step.legs) {
    const double turn_rad = leg.turn_W.norm();
    if (turn_rad > kLeast_rad)
      arrows.push_back(turnArc(at_W, target_W.size(), leg.turn_W / turn_rad, turn_rad));
    at_W += leg.move_W;
  }
  return arrows;
}

}  // namespace

RenderScene bookMeshes(const scenes::Scene& scene) {
  RenderScene drawn = drawnMeshes(scene);
  for (DrawnMesh& mesh : drawn) mesh.is_fixed = false;
  return drawn;
}

std::vector<BookRow> rowsOf(const scenes::Book& book, const scenes::BookStep& step) {
  std::vector<BookRow> rows;
  const auto add = [&](const std::string& name, bool is_moved) {
    const std::size_t number = book.items[book.parts.at(name).item].number;
    const auto known = std::ranges::find_if(
        rows, [&](const BookRow& row) { return row.number == number && row.is_moved == is_moved; });
    if (known == rows.end())
      rows.push_back({number, {name}, is_moved});
    else
      known->names.push_back(name);
  };
  for (const std::string& name : step.planned.parts) add(name, true);
  for (const scenes::BookNeighbour& neighbour : step.neighbours) add(neighbour.name, false);
  return rows;
}

BookPicture coverPicture(const RenderScene& drawn, const scenes::Book& book, double aspect) {
  BookPicture picture;
  const Pose X_WV = viewFrame(book), X_VW = X_WV.inverse();
  Box box_V;
  const auto placeOf = [](const scenes::BookPart& part) {
    return Pose::translation(part.apart_W) * part.X_WP;
  };
  for (const auto& [name, part] : book.parts) {
    picture.snapshot.bodies.push_back({part.part, placeOf(part), scenes::BodyRole::Mounted});
    addBox(box_V, moved(part.box_P, X_VW * placeOf(part)));
  }
  frameBook(box_V, X_WV, aspect, picture);
  for (const scenes::BookItem& item : book.items) {
    const scenes::BookPart& part = book.parts.at(item.names.front());
    picture.balloons.push_back(
        {item.number, item.names.front(),
         anchorOf(*drawn[part.part].mesh, part.box_P, placeOf(part), picture.camera.eye_W)});
  }
  return picture;
}

BookPicture stepPicture(const RenderScene& drawn, const scenes::Book& book,
                        const std::vector<std::string>& in_place, const scenes::BookStep& step,
                        double aspect) {
  BookPicture picture;
  scenes::Snapshot& snapshot = picture.snapshot;
  const scenes::PlannedStep& planned = step.planned;
  const Pose X_WV = viewFrame(book), X_VW = X_WV.inverse();
  const Pose start_W = planned.before_W.empty() ? Pose() : planned.before_W.front();
  Box whole_V, close_V, target_W;
  for (const std::string& name : in_place) {
    const scenes::BookPart& part = book.parts.at(name);
    snapshot.bodies.push_back({part.part, part.X_WP, scenes::BodyRole::Mounted});
    addBox(whole_V, moved(part.box_P, X_VW * part.X_WP));
  }
  for (const std::string& name : planned.parts) {
    const scenes::BookPart& part = book.parts.at(name);
    snapshot.bodies.push_back({part.part, start_W * part.X_WP, scenes::BodyRole::InHand});
    addBox(target_W, part.box_W());
    addBox(close_V, moved(part.box_P, X_VW * part.X_WP));
    for (const Pose& before_W : planned.before_W)
      addBox(close_V, moved(part.box_P, X_VW * before_W * part.X_WP));
  }
  addBox(whole_V, close_V);
  if (planned.parts.size() == 1) {
    const scenes::BookPart& part = book.parts.at(planned.parts.front());
    snapshot.has_target = true;
    snapshot.target_part = part.part;
    snapshot.X_WP_target = part.X_WP;
  }
  // A small part of a large assembly is shown with what is around it instead of the whole.
  constexpr double kAround = 0.15;
  if (!close_V.isEmpty()) {
    const Box around_V =
        grown(close_V, std::max(kAround * whole_V.size().norm(), 0.5 * close_V.size().norm()));
    whole_V = intersection(whole_V, around_V);
  }
  frameBook(whole_V, X_WV, aspect, picture);
  for (const BookRow& row : rowsOf(book, step)) {
    const scenes::BookPart& part = book.parts.at(row.names.front());
    const Pose X_WP = row.is_moved ? start_W * part.X_WP : part.X_WP;
    picture.balloons.push_back({row.number, row.names.front(),
                                anchorOf(*drawn[part.part].mesh, part.box_P, X_WP, picture.camera.eye_W),
                                row.is_moved});
  }
  if (!target_W.isEmpty()) picture.arrows_W = arrowsOf(step, target_W);
  return picture;
}

}  // namespace vps::viewer
