// SPDX-License-Identifier: BSD-3-Clause
// The readers of CAD formats, their common result, and the steps by which importCad() finishes that result.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/formats.h"
#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps/stoppable.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes::import {

/// A part as in its file: triangles not yet welded, lengths in file units; the name may be empty or repeated.
struct RawPart {
  std::string name;
  Mesh mesh;
  Eigen::Affine3d X_WP = Eigen::Affine3d::Identity();  ///< may scale or mirror
  Color color = ImportedPart().color;                  ///< linear RGB
  double deviation_m = 0;                ///< measured distance of the mesh from the file's exact faces
  std::string note;                      ///< defect of the part, in words, for a warning; empty: none
  std::vector<std::string> within = {};  ///< see ImportedPart
  double rounding = 0;                   ///< as ImportedPart::rounding_m, in file units
  FaceColors face_colors = {};           ///< may give all triangles one colour
};

/// The greatest displacement of a vertex in the assembly by the rounding of its coordinates, and of the
/// part's transform, to 32-bit floats.
double floatRounding(const Mesh& mesh, const Eigen::Affine3d& X_WP = Eigen::Affine3d::Identity());

/// The meaning of open shapes that together form a closed surface.
enum class Shapes {
  AreParts,     ///< each open shape is a part
  BoundBodies,  ///< VRML from CAD, a shape for each face: each connected surface is a part
  BoundOne,     ///< OBJ of one part, a group for each face
};

struct RawCad {
  std::vector<RawPart> parts;
  std::vector<std::string> warnings;
  double unit_m = 1;         ///< metres per file unit
  bool states_unit = false;  ///< The file states its unit, so that the unit of the settings is not used.
  Shapes open_shapes = Shapes::AreParts;
  std::string missing;  ///< geometry that is in no part, in words, also among the warnings

  void warnOfMissing(const std::string& words) {
    warnings.push_back(words);
    missing.append(missing.empty() ? "" : "; ").append(words);
  }
};

// The readers, one for each library (see FormatRow). Each reader throws LoadError for a file that it cannot
// read.
RawCad readOcct(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                const Progress& progress);
/// The version of Open CASCADE; empty in a build without Open CASCADE.
std::string occtVersion();
RawCad readCoin(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                const Progress& progress);
RawCad readAssimp(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                  const Progress& progress);
RawCad read3mf(const std::string& file, const FileFormat& format, const ImportSettings& settings,
               const Progress& progress);
/// Reads a binary STL file without colours, with the result of readAssimp(). Empty for any other file.
std::optional<RawCad> readBinaryStl(const std::string& file, const ImportSettings& settings);

inline constexpr std::string_view kLacks = ", which this build lacks; install ";

/// The error of a format whose library this build lacks.
inline LoadError missingLibrary(const std::string& file, const std::string& format,
                                const std::string& library, const std::string& package) {
  return {file, "", (format + " needs " + library).append(kLacks) + package + " and build again"};
}

/// Recognizes missingLibrary() by its words, since errors come from the reader's process as text.
inline bool isMissingLibrary(const LoadError& error) {
  return std::string_view(error.what()).find(kLacks) != std::string_view::npos;
}

/// The byte order mark of UTF-8, with which some programs begin text files.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

inline std::string_view withoutByteOrderMark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

/// Converts raw parts to metres and rigid poses, welds, joins shapes to parts, makes names unique, adds
/// warnings.
/// @param work  receives the progress
void finish(RawCad raw, ImportedCad& cad, StoppableWork& work);

/// Renames parts so that no name is repeated; a part without a name gets `fallback`.
void nameUniquely(std::vector<ImportedPart>& parts, const std::string& fallback);

/// A warning that several files seem to lie each in a frame of its own, see own_frames.cpp; empty if they do
/// not.
/// @param ends        for each file, the number of parts up to its last part
/// @param query_count receives the number of distances that were computed; may be null
std::string ownFramesWarning(const std::vector<ImportedPart>& parts, const std::vector<std::size_t>& ends,
                             std::size_t* query_count = nullptr);

/// Rotates the parts by the least angle that turns the axis into z.
void turnUp(ImportedCad& cad, const Vec3& axis);
/// For formats with FormatRow::is_up_open: rotates the parts so that y becomes z, unless they would tip over
/// easily with y up and stand firmly with z up. Adds a warning that names the chosen axis.
void guessUp(ImportedCad& cad);

/// The format of a file, by content where possible, else by extension. Throws LoadError for a file that is
/// missing, a folder, empty, or cut (where the format defines its end).
FileFormat detectFormat(const std::string& file);

/// The file's name without its folder and extensions, used for parts without a name.
std::string stem(const std::string& file);

/// Display colour (sRGB) to linear. Source: IEC 61966-2-1.
std::array<float, 3> linearFromSrgb(const std::array<float, 3>& srgb);

}  // namespace vps::scenes::import
