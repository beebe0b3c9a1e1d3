// SPDX-License-Identifier: BSD-3-Clause
// The table of CAD formats. A further library needs its reader (a source, and a declaration in readers.h),
// and for each of its formats a value of CadFormat and a row in formats.cpp.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "vps_scenes/cad/import.h"

namespace vps::scenes::import {

struct RawCad;

enum class CadFormat {
  Step,
  Iges,
  Brep,
  Inventor,
  Vrml,
  ThreeMf,
  Gltf,
  Collada,
  Stl,
  Obj,
  Ply,
  Off,
  ThreeDs,
  X3d,
  Fbx,
  Other,  ///< a file of another extension, which assimp may read
};

/// The facts about a format that the import depends on.
struct FormatRow;

/// The format of a file, as detectFormat() finds it.
struct FileFormat {
  CadFormat id = CadFormat::Other;
  std::string name = {};  ///< in reports and messages; of CadFormat::Other, the file's extension in capitals

  FileFormat(CadFormat of);  // NOLINT(google-explicit-constructor): an identifier names its format completely
  [[nodiscard]] const FormatRow& row() const;
};

using ReadFile = RawCad (*)(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                            const Progress& progress);

struct FormatRow {
  CadFormat id;
  std::string_view name;
  std::array<std::string_view, 2> extensions;  ///< lower case, without a point
  const char* library;                         ///< name of the reader's library, in messages
  ReadFile read;
  /// The file describes its faces exactly, so that its parts are triangulated and have a deflection.
  bool has_exact_faces = false;
  /// The format defines y as up, but many programs write z, and no file states which.
  bool is_up_open = false;
  bool has_no_unit = false;  ///< no file of the format states its unit
  /// Version of the library; null for a format whose parts are not kept between runs (kept_cad.cpp).
  std::string (*version)() = nullptr;
  /// Reads some files of the format without the library and without a child process; called before `read`.
  std::optional<RawCad> (*read_here)(const std::string& file, const ImportSettings& settings) = nullptr;
};

/// All rows, in the order of CadFormat.
std::span<const FormatRow> formatRows();

/// The format that has this extension, in any case and without its point; CadFormat::Other if none has it.
CadFormat formatOfExtension(std::string_view extension);

/// Metres per unit of a mesh format; throws LoadError where neither the format nor the settings state it.
double unitOf(const std::string& file, const FileFormat& format, const ImportSettings& settings);

}  // namespace vps::scenes::import
