// SPDX-License-Identifier: BSD-3-Clause
#include "input/file_kind.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "input/cad_arguments.h"
#include "output/terminal.h"
#include "vps/solid.h"
#include "vps/stoppable.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/scene/model_options.h"

namespace vps::viewer {

std::string lowerExtension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void requireSceneFile(const std::string& file) {
  const std::string extension = lowerExtension(file);
  if (scenes::isCadExtension(extension))
    throw LoadError(file, "",
                    "is a CAD file, not a scene; make a scene of it first: vps import " + file + " -o DIR");
  if (extension == ".vdb")
    throw LoadError(file, "", "is a level set, not a scene; vps query and vps export use level sets");
  if (extension == ".mcap")
    throw LoadError(file, "", "is a recording, not a scene; run it again with: vps replay " + file);
}

void requireCadFile(const std::string& file) {
  const std::string extension = lowerExtension(file);
  if (extension == ".vdb")
    throw LoadError(
        file, "",
        "is a level set and has no mesh; vps query takes it as the first part, and vps export writes "
        "such files from a mesh");
  if (extension == ".toml")
    throw LoadError(file, "", "is a scene already; vps assemble, vps simulate and vps explain read scenes");
}

namespace {

/// Reads the header, which is text in every PLY format.
bool hasNormalsAndNoFaces(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  bool has_normals = false;
  constexpr int kMaxLines = 1000;  // so that a file of another format is not read to its end
  for (int i = 0; i < kMaxLines && std::getline(in, line); ++i) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.starts_with("property ") && line.ends_with(" nx")) has_normals = true;
    if (line.starts_with("element face ") && line != "element face 0") return false;
    if (line == "end_header") return has_normals;
  }
  return false;
}

}  // namespace

OperandKind operandKind(const std::string& file) {
  const std::string extension = lowerExtension(file);
  if (extension == ".vdb") return OperandKind::LevelSet;
  if (extension == ".ply" && hasNormalsAndNoFaces(file)) return OperandKind::PointShell;
  return OperandKind::Mesh;
}

Mesh readMesh(const std::string& file, std::optional<double> unit_m) {
  scenes::ImportSettings settings;
  settings.unit_m = unit_m;
  ProgressBar bar;
  const scenes::ImportedCad cad = scenes::importCad(file, settings, bar.progress());
  bar.clear();
  for (const std::string& warning : cad.warnings) warn(file + ": " + warning);
  if (unit_m && cad.states_unit) warn(file + ": " + kUnusedUnits);
  Mesh mesh;
  for (const scenes::ImportedPart& part : cad.parts) append(mesh, transformed(part.mesh, part.X_WP));
  requireUsable(mesh, file, "");
  return mesh;
}

VoxMap mapOf(const Mesh& mesh, const VoxMapSettings& settings, const std::string& file,
             const std::optional<VoxMapCache>& cache, const Progress& progress) {
  const StoppableWork work(progress, "repairing the mesh");
  MeshReport report;
  VoxMap map = cache ? cache->build(mesh, settings, file, progress, &report)
                     : buildVoxMap(Solid(mesh, file), settings, file, progress, &report);
  if (const std::string warning = scenes::meshWarning(report); !warning.empty()) warn(file + ": " + warning);
  return map;
}

double spacingFor(const Mesh& mesh, std::size_t point_count) {
  return std::sqrt(area(mesh) / static_cast<double>(point_count));
}

}  // namespace vps::viewer
