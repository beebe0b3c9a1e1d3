// SPDX-License-Identifier: BSD-3-Clause
// Reads CAD files as parts with names, poses and colours, in metres.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vps/mesh.h"
#include "vps/progress.h"
#include "vps_scenes/export.h"

namespace vps::scenes::inline v0 {

struct ImportSettings {
  /// Metres per file unit, for formats without a unit (STL, OBJ, PLY, ...); empty: such a file is refused.
  /// Formats that state their unit (STEP, IGES, glTF, Inventor with Units) ignore it.
  std::optional<double> unit_m;
  /// Greatest distance between a curved face and its triangles [m] (STEP, IGES).
  double deflection_m = 1e-6;
  double angle_rad = 0.35;  ///< greatest angle between neighbouring triangles of a curved face
  /// The file's axis that is up: the parts are turned so that it becomes z. Empty: the file's axes are kept.
  std::optional<Vec3> up = {};
  /// Runs the format's library in a child process (POSIX), so that a crash on a damaged file becomes a
  /// LoadError. False: in this process, for a debugger, or where other threads use Open CASCADE or Coin
  /// themselves.
  bool in_own_process = true;
};

struct ImportedPart {
  std::string name;  ///< unique within the file: a repeated name becomes "<name>_2" and so on
  Mesh mesh;         ///< welded, in the part's own frame, metres
  Pose X_WP;         ///< pose in the assembly
  std::array<float, 3> color = {0.7f, 0.72f, 0.75f};  ///< linear RGB
  /// Greatest distance of the mesh from the faces that the file describes exactly (STEP, IGES, BREP): as
  /// asked for, or more where it was measured to be more; empty for a file of meshes.
  std::optional<double> deflection_m = {};
  std::string note = {};  ///< what is wrong with the mesh beside those faces, also among the warnings
};

struct ImportedCad {
  std::string file;
  std::string format;  ///< "STEP", "STL", ...
  std::vector<ImportedPart> parts;
  std::vector<std::string> warnings;  ///< open edges, flipped facets and the like, one line each
};

/// Reads STEP, IGES and BREP (Open CASCADE), .iv and .wrl (Coin), and the formats of assimp. The format is
/// detected from content and extension. Each solid (STEP) or closed shape becomes a part. Open shapes that
/// together form a closed surface, as where an exporter wrote a shape for each face, are joined. glTF and
/// Collada are y-up by definition and are rotated to z-up; other files keep their axes. Inventor without
/// Units and VRML are in metres unless unit_m is given. Throws LoadError if the file is missing, cut, empty
/// or damaged, its unit is unknown, or its format is not built in (the message names the package).
VPS_SCENES_API ImportedCad importCad(const std::string& file, const ImportSettings& settings = {},
                                     const Progress& progress = {});

/// The parts of several files in one frame, as if they were one file, which has the name of the first.
VPS_SCENES_API ImportedCad importCad(const std::vector<std::string>& files,
                                     const ImportSettings& settings = {}, const Progress& progress = {});

/// An axis from "x", "-x", "y" and so on; empty for other text.
VPS_SCENES_API std::optional<Vec3> axisFromText(const std::string& text);
/// Metres per unit of "mm", "cm", "m", "um" and "inch"; empty for other text.
VPS_SCENES_API std::optional<double> unitFromText(const std::string& text);
/// Parses a length with its unit, "0.2mm" or "20um"; throws LoadError naming `what` when the unit is missing.
VPS_SCENES_API double lengthFromText(const std::string& text, const std::string& what);

}  // namespace vps::scenes::inline v0
