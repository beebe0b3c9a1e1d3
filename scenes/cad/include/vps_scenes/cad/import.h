// SPDX-License-Identifier: BSD-3-Clause
// Reads CAD files as parts with names, poses and colours, in metres.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps/byte_cache.h"
#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps_scenes/cad/colors.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// Which geometry of a file becomes one part.
enum class PartPer {
  /// Each solid, closed surface or object of the file. Open groups of an OBJ file that together are closed
  /// become one part, and so do connected shapes of VRML, since exporters write a shape for each face.
  Body,
  Object,  ///< each object, group or shape of the file, also where open shapes form a closed surface
  File,    ///< the whole file, under the file's name
};

struct ImportSettings {
  /// Metres per file unit, for formats without a unit (STL, OBJ, PLY, ...); empty: such a file is refused.
  /// Files that state their unit (STEP, IGES, glTF, 3MF, Collada, Inventor with Units) ignore this setting.
  std::optional<double> unit_m;
  /// Greatest distance between a curved face and its triangles [m] (STEP, IGES).
  double deflection_m = 1e-6;
  double angle_rad = 0.35;  ///< greatest angle between neighbouring triangles of a curved face
  /// A part that would have more triangles is read with a deflection that is greater by a power of four, up
  /// to coarsest_m, with a warning. 0: no limit.
  std::size_t most_triangles = 0;
  double coarsest_m = 64e-6;
  /// The file's axis that is up: the parts are rotated so that this axis becomes z. Empty: the file's axes
  /// are kept.
  std::optional<Vec3> up = {};
  /// If `up` is empty and all files are of formats that define y as up, but in which many programs write z
  /// (Inventor, VRML): takes y as up, unless the parts would tip over easily with y up and not with z up. A
  /// warning names the chosen axis.
  bool guesses_up = false;
  PartPer part_per = PartPer::Body;
  /// Runs the format's library in a child process (POSIX), so that a crash on a damaged file becomes a
  /// LoadError. False: runs the library in this process, for a debugger, or in a program whose other threads
  /// use Open CASCADE or Coin.
  bool in_own_process = true;
  /// Limit of the child process, which is ended with a LoadError when it exceeds the limit; 0: half of the
  /// machine's memory.
  std::uint64_t most_memory_bytes = 0;
  /// Limit of the time to read all files and to weld their meshes, which then end with a LoadError; 0: no
  /// limit.
  double most_s = 0;
  /// Cache in which the parts of STEP, IGES and BREP files are kept by the file's content and these settings;
  /// null: the parts are made again each time. A file that names other files is always read.
  const ByteCache* cache = nullptr;
};

struct ImportedPart {
  std::string name;  ///< unique within the file: a repeated name becomes "<name>_2" and so on
  Mesh mesh;         ///< welded, in the part's own frame, metres
  Pose X_WP;         ///< pose in the assembly
  Color color = {0.7f, 0.72f, 0.75f};  ///< linear RGB; the colour of most of the area if faces differ
  /// Greatest distance of the mesh from the faces that the file describes exactly (STEP, IGES, BREP): the
  /// deflection of the settings, or the measured distance if greater; empty for a file of meshes.
  std::optional<double> deflection_m = {};
  std::string note =
      {};  ///< deviation of the mesh from the exact faces in words, also among the warnings; empty: none
  /// Names of the assemblies that contain the part, from the outermost, then the name of its product, if the
  /// format has a tree (STEP, IGES, 3MF). Names of instances are unique: a repeated name becomes "<name>_2"
  /// and so on.
  std::vector<std::string> within = {};
  /// Greatest distance of the part's vertices from their places in the file, or from their places before the
  /// file rounded them to 32-bit floats, which are 15 um apart at 300 m. 0: less than 0.05 um.
  double rounding_m = 0;
  FaceColors face_colors = {};
};

struct ImportedCad {
  std::string file;
  std::string format;  ///< "STEP", "STL", ...
  std::vector<ImportedPart> parts;
  std::vector<std::string> warnings;  ///< open edges, flipped facets and other defects, one line each
  /// All files state their unit, so that the unit of the settings was not used.
  bool states_unit = false;
  std::string missing = {};  ///< geometry that is in no part, in words, also among the warnings; empty: none
};

/// Reads STEP, IGES and BREP (Open CASCADE), .iv and .wrl (Coin), .3mf (lib3mf), and the formats of assimp.
/// The format is detected from content and extension. Each solid (STEP) or closed shape becomes a part. Open
/// shapes that together form a closed surface are joined: some exporters write a shape for each face.
/// glTF and Collada are y-up by definition and are rotated to z-up; other files keep their axes. Inventor
/// without Units, VRML, and Collada without a unit are in metres unless unit_m is given, STEP and IGES
/// without a unit are in millimetres. Throws LoadError if the file is missing, cut, empty or damaged, its
/// unit is unknown, or its format is not built in (the message names the package).
VPS_SCENES_API ImportedCad importCad(const std::string& file, const ImportSettings& settings = {},
                                     const Progress& progress = {});

/// Reads the parts of several files in one frame, as if they were one file with the name of the first file.
/// First refuses a file that is missing, empty, cut, or without a unit, before it reads any of the files.
/// Adds a warning if the files seem to lie in frames of their own, that is, if the parts of each file lie
/// about the origin and overlap the parts of another file.
VPS_SCENES_API ImportedCad importCad(const std::vector<std::string>& files,
                                     const ImportSettings& settings = {}, const Progress& progress = {});

/// Whether files with this extension (".step", "STL", with or without its leading point) are CAD or mesh
/// files that importCad() reads. assimp may read a file of another extension as well.
VPS_SCENES_API bool isCadExtension(std::string_view extension);

/// Parts that move as one body.
struct PartGroup {
  std::string name;
  std::vector<std::string> parts;  ///< names of its parts, two or more
  std::string reason;              ///< why they are a group, in words
};

struct GroupWishes {
  bool is_proposed = true;  ///< partGroups() also looks for groups in the file
  /// One group for each element: the name of an assembly or product of the file, or a pattern of part names
  /// with *.
  std::vector<std::string> names = {};
};

/// The groups of `wishes.names`, and the groups that the file suggests: the solids of one product, and open
/// surfaces that share edges. If all parts would become one body, no group is suggested, and a warning is
/// added to `cad.warnings`. Throws LoadError for a name that stands for fewer than two parts, or for parts of
/// another group.
VPS_SCENES_API std::vector<PartGroup> partGroups(ImportedCad& cad, const GroupWishes& wishes);

/// An axis from "x", "-x", "y" and so on; empty for other text.
VPS_SCENES_API std::optional<Vec3> axisFromText(const std::string& text);
/// Metres per unit of "mm", "cm", "m", "um" and "inch"; empty for other text.
VPS_SCENES_API std::optional<double> unitFromText(const std::string& text);
/// Parses a length with its unit, "0.2mm" or "20um"; throws LoadError naming `what` when the unit is missing.
VPS_SCENES_API double lengthFromText(const std::string& text, const std::string& what);
/// Parses an angle with its unit, "2deg" or "0.01rad", in radians; throws LoadError naming `what` when the
/// unit is missing.
VPS_SCENES_API double angleFromText(const std::string& text, const std::string& what);

}  // namespace vps::scenes
