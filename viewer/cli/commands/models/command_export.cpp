// SPDX-License-Identifier: BSD-3-Clause
// vps export: writes the models of one part: voxmap (.vdb), pointshell (.ply) or mesh (.stl).
#include <cstdio>
#include <memory>

#include "input/file_kind.h"
#include "input/level_set_file.h"
#include "input/mesh_file.h"
#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps/mesh_repair.h"
#include "vps/pointshell.h"
#include "vps/solid.h"
#include "vps/voxmap.h"

namespace vps::viewer {

namespace {

struct ExportArguments {
  std::string source;  ///< CAD file, scene or level set
  std::string part;    ///< name of a part of a scene; empty: its only part
  std::vector<std::string> out;
  std::string units, cache, json;
  FidelityArguments fidelity;
};

/// The geometry to export: in the part's own frame, or for a CAD file in the file's frame.
struct Source {
  Mesh mesh;
  std::optional<VoxMap> map;  ///< set for a .vdb file, which has no mesh
  Fidelity fidelity;
};

const scenes::ScenePart& partOf(const scenes::Scene& scene, const ExportArguments& given) {
  std::string names;
  for (const scenes::ScenePart& part : scene.parts) {
    if (part.part.name == given.part) return part;
    names += (names.empty() ? "" : ", ") + part.part.name;
  }
  if (given.part.empty() && scene.parts.size() == 1) return scene.parts.front();
  throw LoadError(given.source, given.part,
                  given.part.empty() ? "has several parts; choose one with --part: " + names
                                     : "is not in the scene; its parts are: " + names);
}

Source sourceFrom(const ExportArguments& given) {
  const std::string extension = lowerExtension(given.source);
  if (extension == ".toml") {
    const scenes::Scene scene = sceneFrom(given.source, given.fidelity, given.out, {.folder = given.cache});
    const scenes::ScenePart& part = partOf(scene, given);
    Source source = {part.part.mesh, {}, scene.fidelity};
    if (part.voxel_m > 0) source.fidelity.voxel_m = part.voxel_m;
    if (part.spacing_m > 0) source.fidelity.spacing_m = part.spacing_m;
    requireUsable(source.mesh, given.source, given.part);
    return source;
  }
  if (!given.part.empty())
    throw LoadError("", "", "--part needs a scene; " + given.source + " is not a scene");
  if (extension == ".vdb") {
    return {{}, loadLevelSet(given.source), {}};
  }
  Mesh mesh = readMesh(given.source, unitFrom(given.units));
  std::string choice;
  const Fidelity fidelity = fidelityFrom(given.fidelity, {mesh, given.source}, nullptr, choice);
  sayChoice(choice);
  return {std::move(mesh), {}, fidelity};
}

VoxMap mapFrom(const Source& source, const ExportArguments& given, const Progress& progress) {
  if (source.map) return *source.map;
  return mapOf(source.mesh, {.voxel_m = source.fidelity.voxel_m}, given.source, cacheFrom(given.cache),
               progress);
}

const Mesh& meshOf(const Source& source, const ExportArguments& given, const std::string& file) {
  if (source.map)
    throw LoadError(given.source, "",
                    "is a level set and has no mesh, which " + file + " needs; give a CAD file");
  return source.mesh;
}

/// Writes one file to `partial`. Returns the file's row of the result.
ExportedFileAnswer writeModel(const Source& source, const ExportArguments& given, const std::string& file,
                              const std::string& partial, const Progress& progress) {
  ExportedFileAnswer row;
  row.file = file;
  const std::string extension = lowerExtension(file);
  if (extension == ".vdb") {
    const VoxMap map = mapFrom(source, given, progress);
    saveLevelSet(map, partial);
    row.model = "voxmap";
    row.voxel_m = map.voxel_m();
    row.bricks = map.brickCount();
  } else if (extension == ".ply") {
    const Mesh& mesh = meshOf(source, given, file);
    const double spacing_m =
        given.fidelity.points > 0 ? spacingFor(mesh, given.fidelity.points) : source.fidelity.spacing_m;
    const PointShell shell =
        buildPointShell(Solid(mesh, given.source), {.spacing_m = spacing_m}, given.source, progress);
    savePly(shell, partial);
    row.model = "pointshell";
    row.points = shell.size();
    row.point_spacing_m = spacing_m;
  } else {
    const Mesh& mesh = meshOf(source, given, file);
    writeWholeFile(partial, stlBytes(mesh));
    row.model = "mesh";
    row.triangles = mesh.triangles.size();
  }
  return row;
}

/// Checks the file name before the work, because building a voxmap takes time.
void requireExportable(const std::string& file) {
  const std::string extension = lowerExtension(file);
  if (extension != ".vdb" && extension != ".ply" && extension != ".stl")
    throw LoadError(file, "", "cannot be exported; expected .vdb (voxmap), .ply (pointshell) or .stl (mesh)");
  if (extension == ".vdb") requireOpenVdb(file);
}

std::string describe(const ExportedFileAnswer& row) {
  if (row.model == "voxmap")
    return std::to_string(row.bricks) + " bricks, voxels of " + fixed(1e3 * row.voxel_m, 3) + " mm";
  if (row.model == "pointshell")
    return std::to_string(row.points) + " points every " + fixed(1e3 * row.point_spacing_m, 3) + " mm";
  return std::to_string(row.triangles) + " triangles";
}

int runExport(const ExportArguments& given) {
  std::vector<std::unique_ptr<OutputFile>> outputs;
  for (const std::string& file : given.out) {
    requireExportable(file);
    outputs.push_back(std::make_unique<OutputFile>(file, std::vector<std::string>{given.source}));
  }
  OutputFile json(given.json, {given.source});
  ProgressBar bar;
  const Source source = sourceFrom(given);
  ExportAnswer answer;
  answer.source = given.source;
  answer.part = given.part;
  for (std::size_t i = 0; i < outputs.size(); ++i)
    answer.files.push_back(writeModel(source, given, given.out[i], outputs[i]->partial(), bar.progress()));
  throwIfStopped();
  for (const auto& output : outputs) output->commit();
  json.write(toJson(answer));
  bar.clear();
  for (const ExportedFileAnswer& row : answer.files)
    std::printf("%s: %s, %s\n", row.file.c_str(), row.model.c_str(), describe(row).c_str());
  return kGood;
}

}  // namespace

std::function<int()> addExport(CLI::App& command) {
  const auto given = std::make_shared<ExportArguments>();
  command.add_option("source", given->source, "CAD file, scene (TOML) or level set (.vdb)")
      ->required()
      ->type_name("PART_OR_SCENE");
  command.add_option("-o,--out", given->out, "file to write, .vdb, .ply or .stl; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE");
  command.add_option("--part", given->part, "name of the part, for a scene with several")->type_name("NAME");
  addUnitsOption(command, given->units);
  addFidelityOptions(command, given->fidelity);
  command.remove_option(command.get_option("--sides"));  // --sides belongs to a query
  addPointsOption(command, given->fidelity);
  addCacheOption(command, given->cache);
  addJsonOption(command, given->json);
  return [given] { return runExport(*given); };
}

}  // namespace vps::viewer
