// SPDX-License-Identifier: BSD-3-Clause
// The pictures of an instruction book: what they show, and the balloons and arrows that are drawn over them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vps_scenes/planning/book.h"
#include "vps_viewer/draw/camera.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// The sides of an assembly as the pictures show it, as unit vectors: up is against gravity.
struct BookSides {
  Vec3 right_W, front_W, up_W;
};
BookSides sidesOf(const Vec3& up_W);

/// A number in a circle, with a line to a part.
struct BookBalloon {
  std::size_t number = 0;  ///< BookItem::number
  std::string name;        ///< the part to which the line leads
  Vec3 at_W = Vec3::Zero();
  bool is_moved = false;  ///< the part is one that the step moves
};

/// A picture, before it is drawn.
struct BookPicture {
  scenes::Snapshot snapshot;
  Camera camera;
  std::vector<BookBalloon> balloons;
  std::vector<Vec3> corners_W;  ///< corners of a box around what is shown; balloons stand beside it
  std::vector<std::vector<Vec3>> arrows_W;  ///< chains of points; the head is at the last point
};

/// The meshes of the scene; only parts that a snapshot lists are drawn.
RenderScene bookMeshes(const scenes::Scene& scene);

/// The exploded view of all parts, with a balloon for each item.
/// @param aspect  width over height of the picture
BookPicture coverPicture(const RenderScene& drawn, const scenes::Book& book, double aspect);

/// A step: the parts in place, and the step's parts at the start of their path. Balloons name the step's
/// parts and the parts that these touch or fit into; arrows follow the path and turn with it.
BookPicture stepPicture(const RenderScene& drawn, const scenes::Book& book,
                        const std::vector<std::string>& in_place, const scenes::BookStep& step,
                        double aspect);

/// The items that the balloons of a step may name, each once: first those that the step moves, with the names
/// of the parts in this step.
struct BookRow {
  std::size_t number = 0;
  std::vector<std::string> names;
  bool is_moved = false;
};
std::vector<BookRow> rowsOf(const scenes::Book& book, const scenes::BookStep& step);

/// The picture as SVG: an image with arrows and balloons over it. The balloons stand in a column at each side
/// of what is shown, without covering each other.
/// @param image  data URL of the image; empty: arrows and balloons alone
std::string pictureSvg(const BookPicture& picture, const std::string& image, int width, int height);

}  // namespace vps::viewer
