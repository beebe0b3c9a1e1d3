// SPDX-License-Identifier: BSD-3-Clause
// Arrows and discs that show contacts, coloured by depth, and the force on the hand.
#pragma once

#include <array>
#include <vector>

#include "gl/gl_objects.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// Linear RGB of a contact whose depth is the given share of full scale: from yellow (0) over orange and red
/// to dark red (1).
Eigen::Vector3f depthColor(double share);

inline const Eigen::Vector3f kForceColor(
    0.28f, 0.02f, 0.35f);  // violet: distinct from the hand's blue and the depth colours

struct Mark {
  std::array<float, 3> base_C, axis_C;
  std::array<float, 2> size_m;  ///< length, width
  std::array<float, 3> color;
};

/// The marks of a snapshot: arrows for the force and the deepest contacts, discs for all contacts.
struct MarkList {
  std::vector<Mark> arrows, discs;
};
/// @param size_m diameter of the scene in the picture [m]
MarkList listMarks(const scenes::Snapshot& snapshot, const Pose& X_CW, double size_m,
                   const DrawOptions& options);

/// A unit shape along +z, drawn once for each mark.
class MarkShape {
 public:
  static MarkShape arrow();
  static MarkShape disc();
  void draw(const std::vector<Mark>& marks) const;

 private:
  struct Vertex {
    std::array<float, 3> p, n;
  };
  explicit MarkShape(const std::vector<Vertex>& triangles);
  /// The surface of revolution about z through (radius, z) pairs.
  static MarkShape lathe(const std::vector<std::array<double, 2>>& profile);
  gl::Buffer vertices_;
  GLsizei vertex_count_ = 0;
};

}  // namespace vps::viewer
