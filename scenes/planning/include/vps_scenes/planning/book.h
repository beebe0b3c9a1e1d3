// SPDX-License-Identifier: BSD-3-Clause
// The content of an instruction book, without words and pictures: the parts list, the chapters, and what is
// known about each step from the plan, the check and the scene.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vps/box.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {

/// A row of the parts list: a part, or several parts of equal geometry.
struct BookItem {
  std::size_t number = 0;              ///< number of the row, from 1; pictures show it in balloons
  std::vector<std::string> names;      ///< at least one, in the order of assembly
  std::string fastener;                ///< fastener recognized by its shape, in words; empty: none
  Vec3 size_m = Vec3::Zero();          ///< extents of the first part along the axes of its own frame
  std::optional<double> mass_kg = {};  ///< mass of one part; empty: no density is known, or no volume
};

/// A part of the book's pictures.
struct BookPart {
  std::size_t part = 0;  ///< index into Scene::parts
  std::size_t item = 0;  ///< index into Book::items
  Pose X_WP;             ///< pose in the finished assembly
  Box box_P;             ///< box around the part in its own frame
  /// Displacement of the part in the exploded view.
  Vec3 apart_W = Vec3::Zero();
  [[nodiscard]] Box box_W(const Pose& moved_W = {}) const { return moved(box_P, moved_W * X_WP); }
};

/// A piece of a path: straight, turning, or both at once.
struct BookLeg {
  Vec3 move_W = Vec3::Zero();  ///< displacement of the middle of the moved parts' box [m]
  Vec3 turn_W = Vec3::Zero();  ///< rotation vector [rad]; may be longer than a half turn
};

/// A part in place that the parts of a step touch, or that is near them or in a fit with them.
struct BookNeighbour {
  std::string name;
  PairState state = PairState::Apart;
  double clearance_m = 0;  ///< least distance of the surfaces at the target
};

/// A page of the book: a part, or a subassembly that moves as one, is brought to its target.
struct BookStep {
  std::size_t number = 0;  ///< number of the step in the book, from 1
  PlannedStep planned;
  std::vector<BookLeg> legs;              ///< the path from its start; equal motions in a row are one leg
  std::vector<PlannedOrder> needs;        ///< steps and base parts that have to come before this step
  std::vector<BookNeighbour> neighbours;  ///< in the order of the contacts of the plan
  std::vector<CheckedFit> fits;           ///< fits of the step's parts with parts in place
  std::vector<CheckedPart> measured;      ///< the step's parts whose play in the finished assembly is known
  double torque_Nm = 0;                   ///< torque that the scene states for the step; 0: none
};

/// The assembly, or a subassembly.
struct BookChapter {
  std::string name;
  std::vector<std::string> fixed;  ///< parts with which the chapter begins
  std::string fixed_reason;        ///< why the chapter begins with the first of `fixed`, in words
  std::vector<BookStep> steps;
};

/// A part that is not in the parts list because the planned scenes do not assemble it.
struct BookLeftOut {
  std::string name;
  std::string reason;  ///< in words
};

struct Book {
  std::string name;
  Vec3 up_W = Vec3::UnitZ();  ///< unit vector against gravity
  std::vector<BookItem> items;
  std::map<std::string, BookPart> parts;  ///< each part of the items, by name
  std::vector<BookChapter> chapters;      ///< each subassembly before the assembly that mounts it
  std::vector<BlockedPart> blocked;       ///< parts for which no path was found, of all assemblies
  std::vector<BookLeftOut> left_out;
  [[nodiscard]] std::size_t steps() const;
};

/// The book of a plan. Steps follow the order of the plan; each subassembly comes before the assembly that
/// mounts it. Every part that the plan assembles is in exactly one row of the parts list.
/// @param scene       the scene that was planned
/// @param checked     a check of the scene's parts as drawn; its fits and its play are taken over
/// @param has_density the densities of the scene's parts are known, so that items get a mass
/// O(parts^2) boxes, and one pass over each mesh.
VPS_SCENES_API Book makeBook(const Scene& scene, const PlanResult& plan, const CheckResult& checked,
                             bool has_density);

}  // namespace vps::scenes
