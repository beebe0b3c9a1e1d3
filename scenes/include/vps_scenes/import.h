// SPDX-License-Identifier: BSD-3-Clause
// CAD files to parts: names, poses, colours, metres.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vps/mesh.h"
#include "vps/progress.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

struct ImportSettings {
  /// Metres per file unit, for formats that do not say (STL, OBJ, PLY, ...); empty: such a file is refused,
  /// with words. Formats that know their unit (STEP, IGES, glTF, Inventor with Units) ignore it.
  std::optional<double> unit_m;
  /// Greatest distance between a curved face and its triangles [m] (STEP, IGES).
  double deflection_m = 1e-6;
  double angle_rad = 0.35;  ///< greatest turn between neighbouring triangles of a curved face
  /// Runs the format's library in a child process (POSIX), so that its crash on a damaged file is a
  /// LoadError. false: in this process, as for a debugger, or where other threads use Open CASCADE or Coin
  /// themselves.
  bool in_own_process = true;
};

struct ImportedPart {
  std::string name;  ///< unique within the file; "<name>_2" and so on where it repeats
  Mesh mesh;         ///< welded, in the part's own frame, metres
  Pose X_WP;         ///< pose in the assembly
  std::array<float, 3> color = {0.7f, 0.72f, 0.75f};  ///< linear RGB
};

struct ImportedCad {
  std::string file;
  std::string format;  ///< "STEP", "STL", ...
  std::vector<ImportedPart> parts;
  std::vector<std::string> warnings;  ///< open edges, flipped facets and the like, one line each
};

/// Reads STEP, IGES and BREP (Open CASCADE), .iv and .wrl (Coin), and whatever assimp reads. Format by
/// content and extension. One part per solid (STEP) or closed shape; open shapes that close one another, as
/// where an exporter wrote a shape per face, are joined. glTF and Collada are y up by definition and are
/// turned to z up; other axes stay. Inventor without Units and VRML are in metres unless unit_m is given.
/// Throws LoadError: file missing, cut, empty, damaged, unit unknown, format not built in (says which
/// package).
VPS_SCENES_API ImportedCad importCad(const std::string& file, const ImportSettings& settings = {},
                                     const Progress& progress = {});

/// Parses "mm", "cm", "m", "um", "inch" to metres per unit; empty if it is none of them.
VPS_SCENES_API std::optional<double> unitFromText(const std::string& text);
/// Parses a length with its unit, "0.2mm" or "20um"; throws LoadError naming `what` when the unit is missing.
VPS_SCENES_API double lengthFromText(const std::string& text, const std::string& what);

}  // namespace vps::scenes
