// SPDX-License-Identifier: BSD-3-Clause
// Colours of triangles in 3MF files, of which assimp 5.2.5 keeps one for each mesh.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/face_colors.h"

namespace vps::scenes::inline v0::import {

/// An object's mesh as the file has it.
struct Mesh3mf {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::optional<Color>> colors;  ///< linear, by triangle: its own, or the object's

  [[nodiscard]] bool hasColors() const;
};

/// Of base materials and colour groups; a triangle whose corners have several has their mean.
/// Source: 3MF Core Specification 1.3, sections 4 and 5, Materials and Properties Extension 1.2, section 3.
/// @param model  text of the file's 3D/3dmodel.model
std::vector<Mesh3mf> meshes3mf(std::string_view model);

/// The text of a 3MF file's model; empty where there is none, where it is damaged or has more than 1 GB, and
/// in a build without minizip.
std::string model3mf(const std::string& file);

}  // namespace vps::scenes::inline v0::import
