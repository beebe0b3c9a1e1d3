// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/fits/part_moves.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "check/three_numbers.h"
#include "scene/scene_file_keys.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {

PartMove partMoveFromText(const std::string& text, const std::string& what) {
  const std::size_t second = text.rfind(','), first = second == std::string::npos || second == 0
                                                          ? std::string::npos
                                                          : text.rfind(',', second - 1);
  if (first == std::string::npos || first == 0)
    throw LoadError(what, "",
                    "'" + text + "' is not a move; write part,axis,length or part,r+axis,angle, like " +
                        "pin,x,0.1mm or pin,rx,2deg");
  PartMove move;
  move.part = text.substr(0, first);
  std::string axis = text.substr(first + 1, second - first - 1);
  const bool is_turn = axis.starts_with('r');
  if (is_turn) axis.erase(0, 1);
  std::optional<Vec3> direction = axisFromText(axis);
  if (!direction) direction = threeNumbers(axis);
  if (!direction || !direction->allFinite() || !(direction->norm() > 0))
    throw LoadError(what, "",
                    "'" + text + "' has the axis '" + axis +
                        "'; expected x, y, z, or a direction like 0:1:1; r before it turns the part");
  move.axis_W = direction->normalized();
  const std::string amount = text.substr(second + 1);
  if (is_turn)
    move.turn_rad = angleFromText(amount, what);
  else
    move.by_m = lengthFromText(amount, what);
  return move;
}

void moveParts(std::vector<DrawnPart>& parts, const std::vector<PartMove>& moves, const std::string& what) {
  for (const PartMove& move : moves) {
    const auto part = std::ranges::find(parts, move.part, &DrawnPart::name);
    if (part == parts.end()) {
      std::vector<std::string> names;
      for (const DrawnPart& known : parts) names.push_back(known.name);
      throw LoadError(what, "",
                      "'" + move.part + "' is not the name of a part" + didYouMean(move.part, names));
    }
    part->X_WP.p += move.by_m * move.axis_W;
    part->X_WP.R = Eigen::AngleAxisd(move.turn_rad, move.axis_W).toRotationMatrix() * part->X_WP.R;
    part->moves.push_back(move);
  }
}

}  // namespace vps::scenes
