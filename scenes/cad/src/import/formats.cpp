// SPDX-License-Identifier: BSD-3-Clause
#include "import/formats.h"

#include <algorithm>
#include <cctype>

#include "import/readers.h"
#include "vps/errors.h"

namespace vps::scenes {
namespace import {
namespace {

constexpr const char *kOcct = "Open CASCADE", *kCoin = "Coin", *kLib3mf = "lib3mf", *kAssimp = "assimp";

// clang-format off
constexpr std::array kRows = {
    FormatRow{.id = CadFormat::Step, .name = "STEP", .extensions = {"step", "stp"}, .library = kOcct,
              .read = readOcct, .has_exact_faces = true, .version = occtVersion},
    FormatRow{.id = CadFormat::Iges, .name = "IGES", .extensions = {"iges", "igs"}, .library = kOcct,
              .read = readOcct, .has_exact_faces = true, .version = occtVersion},
    FormatRow{.id = CadFormat::Brep, .name = "BREP", .extensions = {"brep", "brp"}, .library = kOcct,
              .read = readOcct, .has_exact_faces = true, .has_no_unit = true, .version = occtVersion},
    FormatRow{.id = CadFormat::Inventor, .name = "Inventor", .extensions = {"iv"}, .library = kCoin,
              .read = readCoin, .is_up_open = true},
    FormatRow{.id = CadFormat::Vrml, .name = "VRML", .extensions = {"wrl", "wrz"}, .library = kCoin,
              .read = readCoin, .is_up_open = true},
    FormatRow{.id = CadFormat::ThreeMf, .name = "3MF", .extensions = {"3mf"}, .library = kLib3mf, .read = read3mf},
    FormatRow{.id = CadFormat::Gltf, .name = "glTF", .extensions = {"gltf", "glb"}, .library = kAssimp,
              .read = readAssimp},
    FormatRow{.id = CadFormat::Collada, .name = "DAE", .extensions = {"dae"}, .library = kAssimp,
              .read = readAssimp},
    FormatRow{.id = CadFormat::Stl, .name = "STL", .extensions = {"stl"}, .library = kAssimp, .read = readAssimp,
              .has_no_unit = true, .read_here = readBinaryStl},
    FormatRow{.id = CadFormat::Obj, .name = "OBJ", .extensions = {"obj"}, .library = kAssimp, .read = readAssimp,
              .has_no_unit = true},
    FormatRow{.id = CadFormat::Ply, .name = "PLY", .extensions = {"ply"}, .library = kAssimp, .read = readAssimp,
              .has_no_unit = true},
    FormatRow{.id = CadFormat::Off, .name = "OFF", .extensions = {"off"}, .library = kAssimp, .read = readAssimp,
              .has_no_unit = true},
    FormatRow{.id = CadFormat::ThreeDs, .name = "3DS", .extensions = {"3ds"}, .library = kAssimp,
              .read = readAssimp, .has_no_unit = true},
    FormatRow{.id = CadFormat::X3d, .name = "X3D", .extensions = {"x3d"}, .library = kAssimp, .read = readAssimp},
    FormatRow{.id = CadFormat::Fbx, .name = "FBX", .extensions = {"fbx"}, .library = kAssimp, .read = readAssimp},
    FormatRow{.id = CadFormat::Other, .name = "", .extensions = {}, .library = kAssimp, .read = readAssimp},
};
// clang-format on

constexpr bool isInOrder() {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (kRows[i].id != static_cast<CadFormat>(i)) return false;
  return kRows.back().id == CadFormat::Other;
}
static_assert(isInOrder(), "rowOf() takes the value of a CadFormat for the index of its row");

const FormatRow& rowOf(CadFormat id) {
  return kRows[static_cast<std::size_t>(id)];
}

}  // namespace

FileFormat::FileFormat(CadFormat of) : id(of), name(rowOf(of).name) {}

const FormatRow& FileFormat::row() const {
  return rowOf(id);
}

std::span<const FormatRow> formatRows() {
  return kRows;
}

CadFormat formatOfExtension(std::string_view extension) {
  const auto isSame = [&](std::string_view known) {
    return !known.empty() && std::ranges::equal(extension, known, [](unsigned char a, unsigned char b) {
      return std::tolower(a) == b;
    });
  };
  const auto* const found = std::ranges::find_if(
      kRows, [&](const FormatRow& row) { return std::ranges::any_of(row.extensions, isSame); });
  return found == kRows.end() ? CadFormat::Other : found->id;
}

double unitOf(const std::string& file, const FileFormat& format, const ImportSettings& settings) {
  if (settings.unit_m) return *settings.unit_m;
  // assimp 5.2.5 drops the units that files of some formats state.
  constexpr const char* kRemedy = R"(; set unit = "mm" in the scene or give --units mm)";
  throw LoadError(file, "",
                  (format.row().has_no_unit ? format.name + " files do not state their unit"
                                            : "the unit of " + format.name + " files is not read") +
                      kRemedy);
}

}  // namespace import

bool isCadExtension(std::string_view extension) {
  if (extension.starts_with('.')) extension.remove_prefix(1);
  return import::formatOfExtension(extension) != import::CadFormat::Other;
}

}  // namespace vps::scenes
