// SPDX-License-Identifier: BSD-3-Clause
// What each format's reader hands to importCad(), which makes it metres, welds it and names it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "vps/mesh.h"
#include "vps/progress.h"
#include "vps_scenes/import.h"

namespace vps::scenes::import {

/// A part as its file says it: triangles not yet welded, lengths in file units; the name may be empty or
/// repeat.
struct RawPart {
  std::string name;
  Mesh mesh;
  Eigen::Affine3d X_WP = Eigen::Affine3d::Identity();  ///< may scale or mirror
  std::array<float, 3> color = ImportedPart().color;   ///< linear RGB
};

/// What open shapes mean that close one another.
enum class Shapes {
  AreParts,     ///< nothing: each stays as it is
  BoundBodies,  ///< VRML of CAD, a shape per face: each connected surface is a part
  BoundOne,     ///< OBJ of one part, a group per face
};

struct RawCad {
  std::vector<RawPart> parts;
  std::vector<std::string> warnings;
  double unit_m = 1;  ///< metres per file unit
  Shapes open_shapes = Shapes::AreParts;
};

/// Each throws LoadError; `format` is as detected, e.g. "STEP".
RawCad readOcct(const std::string& file, const std::string& format, const ImportSettings& settings,
                const Progress& progress);
RawCad readCoin(const std::string& file, const std::string& format, const ImportSettings& settings,
                const Progress& progress);
RawCad readAssimp(const std::string& file, const std::string& format, const ImportSettings& settings,
                  const Progress& progress);

/// Metres, rigid poses, welding, shapes joined to parts, unique names, warnings in words.
void finish(RawCad raw, ImportedCad& cad);

/// "STEP", "IGES", "BREP", "Inventor", "VRML", or the extension in capitals; by content where content tells.
/// Throws LoadError: missing, a folder, empty, cut (where the format says how it ends).
std::string detectFormat(const std::string& file);

/// The file's name without folder and extensions, for parts that have no name.
std::string stem(const std::string& file);

/// Display colour (sRGB) to linear. Source: IEC 61966-2-1.
std::array<float, 3> linearFromSrgb(const std::array<float, 3>& srgb);

}  // namespace vps::scenes::import
