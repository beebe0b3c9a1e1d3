// SPDX-License-Identifier: BSD-3-Clause
// Which axis of a file is up.
#include "import/readers.h"

namespace vps::scenes::inline v0 {

void import::turnUp(ImportedCad& cad, const Vec3& axis) {
  const Pose turn(Quat::FromTwoVectors(axis, Vec3::UnitZ()).toRotationMatrix(), Vec3::Zero());
  for (ImportedPart& part : cad.parts) part.X_WP = turn * part.X_WP;
}

std::optional<Vec3> axisFromText(const std::string& text) {
  const bool is_negative = text.starts_with("-");
  const std::string name = text.substr(is_negative ? 1 : 0);
  if (name.size() != 1 || name < "x" || name > "z") return std::nullopt;
  return Vec3((is_negative ? -1 : 1) * Vec3::Unit(name[0] - 'x'));
}

}  // namespace vps::scenes::inline v0
