// SPDX-License-Identifier: BSD-3-Clause
// The readers of CAD formats, and their common result before importCad() finishes it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes::import {

/// A part as in its file: triangles not yet welded, lengths in file units; the name may be empty or repeated.
struct RawPart {
  std::string name;
  Mesh mesh;
  Eigen::Affine3d X_WP = Eigen::Affine3d::Identity();  ///< may scale or mirror
  Color color = ImportedPart().color;                  ///< linear RGB
  double deviation_m = 0;                ///< of the mesh from the file's exact faces, as measured
  std::string note;                      ///< what is wrong with it, for a warning; empty: nothing
  std::vector<std::string> within = {};  ///< see ImportedPart
  double rounding = 0;                   ///< of the vertices in the assembly, in file units, see ImportedPart
  FaceColors face_colors = {};           ///< may have one colour only
};

/// The greatest distance of a vertex in the assembly from where it was before its coordinates, and those of
/// the part's transform, became 32-bit floats.
double floatRounding(const Mesh& mesh, const Eigen::Affine3d& X_WP = Eigen::Affine3d::Identity());

/// The meaning of open shapes that together form a closed surface.
enum class Shapes {
  AreParts,     ///< each is a part
  BoundBodies,  ///< VRML from CAD, a shape for each face: each connected surface is a part
  BoundOne,     ///< OBJ of one part, a group for each face
};

struct RawCad {
  std::vector<RawPart> parts;
  std::vector<std::string> warnings;
  double unit_m = 1;         ///< metres per file unit
  bool states_unit = false;  ///< The file states its unit, so that the unit of the settings is not used.
  Shapes open_shapes = Shapes::AreParts;
  std::string missing;  ///< geometry that no part has, in words, also among the warnings

  void warnOfMissing(const std::string& words) {
    warnings.push_back(words);
    missing.append(missing.empty() ? "" : "; ").append(words);
  }
};

/// Each throws LoadError; `format` is as detected, e.g. "STEP".
RawCad readOcct(const std::string& file, const std::string& format, const ImportSettings& settings,
                const Progress& progress);
/// The version of Open CASCADE; empty in a build without.
std::string occtVersion();
RawCad readCoin(const std::string& file, const std::string& format, const ImportSettings& settings,
                const Progress& progress);
RawCad readAssimp(const std::string& file, const std::string& format, const ImportSettings& settings,
                  const Progress& progress);
RawCad read3mf(const std::string& file, const std::string& format, const ImportSettings& settings,
               const Progress& progress);

/// The byte order mark of UTF-8, with which some programs begin text files.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

inline std::string_view withoutByteOrderMark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

/// A binary STL file without colours; nothing for any other, which readAssimp() reads. Gives what that gives.
std::optional<RawCad> readBinaryStl(const std::string& file, const ImportSettings& settings);

/// Metres per unit of a mesh format; throws LoadError where neither the format nor the settings state it.
double unitOf(const std::string& file, const std::string& format, const ImportSettings& settings);

/// Converts to metres and rigid poses, welds, joins shapes to parts, makes names unique, adds warnings.
void finish(RawCad raw, ImportedCad& cad);

/// Gives each part another name where one is repeated; `fallback` where it has none.
void nameUniquely(std::vector<ImportedPart>& parts, const std::string& fallback);

/// A warning where several files seem to lie each in a frame of its own, see own_frames.cpp; else empty.
/// @param ends        for each file, how many of the parts are of it and of those before
/// @param query_count gets the number of distances that were computed; may be null
std::string ownFramesWarning(const std::vector<ImportedPart>& parts, const std::vector<std::size_t>& ends,
                             std::size_t* query_count = nullptr);

/// Turns the parts so that the axis becomes z, the shortest way.
void turnUp(ImportedCad& cad, const Vec3& axis);
/// For formats that define y as up, which many programs do not heed: turns the parts so that y becomes z,
/// unless they would hardly stand so and stand well with z up; adds a warning with the answer.
void guessUp(ImportedCad& cad);

/// "STEP", "IGES", "BREP", "Inventor", "VRML", or the extension in capitals; by content where possible.
/// Throws LoadError for a file that is missing, a folder, empty, or cut (where the format defines its end).
std::string detectFormat(const std::string& file);

/// The file's name without folder and extensions, for parts without a name.
std::string stem(const std::string& file);

/// Display colour (sRGB) to linear. Source: IEC 61966-2-1.
std::array<float, 3> linearFromSrgb(const std::array<float, 3>& srgb);

}  // namespace vps::scenes::import
