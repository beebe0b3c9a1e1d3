// SPDX-License-Identifier: BSD-3-Clause
// Unions of boxes with parallel axes, whose volume, inertia and distance have formulas.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "support/random_draw.h"
#include "vps/box.h"
#include "vps/mesh.h"

namespace vps::families {

/// Boxes in one frame; they may touch and overlap. Formulas divide space by all faces' planes into cells.
class BoxUnion {
 public:
  explicit BoxUnion(std::vector<Box> boxes);

  [[nodiscard]] const std::vector<Box>& boxes() const { return boxes_; }
  [[nodiscard]] MassProperties mass() const;
  /// Distance to the union. Inside the union, the result is minus the distance to the nearest point that is
  /// not inside.
  [[nodiscard]] double distance(const Vec3& p) const;

 private:
  [[nodiscard]] std::array<std::size_t, 3> cellCounts() const;
  [[nodiscard]] Box cell(const std::array<std::size_t, 3>& at) const;
  [[nodiscard]] bool isSolid(const Box& cell) const;
  template <typename Visit>
  void forEachCell(Visit visit) const;

  std::vector<Box> boxes_;
  std::array<std::vector<double>, 3>
      planes_;  ///< coordinates of the planes, ascending, with one far beyond each end
};

/// A kind of union, and how far its boxes reach into each other.
struct BoxMember {
  std::string kind;
  double overlap_m = 0;  ///< 0: the boxes touch
  std::vector<Box> boxes;
};

/// Member i: a U, L, T, cross or comb of 2 to 9 boxes, boxes that share only part of a face, an edge or a
/// corner, or random boxes.
BoxMember boxMember(int i);

/// One closed shell for each box, in the boxes' frame.
Mesh shellsOf(const std::vector<Box>& boxes);
/// The same closed shells; shell i faces inwards if faces_in[i] is true.
Mesh shellsOf(const std::vector<Box>& boxes, const std::vector<bool>& faces_in);
/// The mass properties of a body after it is moved by X.
MassProperties moved(const MassProperties& mass, const Pose& X);
/// The greatest relative difference of volume, centre (over the size) and inertia.
double difference(const MassProperties& a, const MassProperties& b, double size_m);

}  // namespace vps::families
