// SPDX-License-Identifier: BSD-3-Clause
// vps import: makes a scene from a CAD file: parts as meshes, poses and proposed steps.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "input/cad_arguments.h"
#include "input/file_kind.h"
#include "input/mesh_file.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps/mesh_repair.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/cad/time_limit.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/fasteners.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_scenes/scene/scene_parts.h"
#include "vps_scenes/scene/scene_text.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;

struct ImportArguments {
  std::vector<std::string> files;
  CadArguments cad;
  std::string out, json;
  bool is_forced = false;  ///< replaces an existing scene.toml
};

Box boundsAt(const scenes::ScenePart& part) {
  Box box;
  for (const Vec3& p_P : part.part.mesh.vertices) box.add(part.X_WP * p_P);
  return box;
}

/// A procedure for the user to correct: the largest body is fixed, the others follow from the lowest upwards.
struct Proposal {
  std::string fixed;
  std::vector<std::string> steps;
};

Proposal propose(const std::vector<scenes::ScenePart>& bodies) {
  std::vector<double> volume_m3, foot_m;
  for (const scenes::ScenePart& body : bodies) {
    const Box box = boundsAt(body);
    volume_m3.push_back(box.size().prod());
    foot_m.push_back(box.min.z());
  }
  const auto largest =
      static_cast<std::size_t>(std::max_element(volume_m3.begin(), volume_m3.end()) - volume_m3.begin());
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (i != largest) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return foot_m[a] < foot_m[b]; });
  Proposal proposal{bodies[largest].part.name, {}};
  for (const std::size_t i : order) proposal.steps.push_back(bodies[i].part.name);
  return proposal;
}

/// Whether `part` is the part of `body` that is marked as fixed: only the first part of a group is marked.
bool isOf(const std::string& part, const std::string& body, const std::vector<scenes::PartGroup>& groups) {
  for (const scenes::PartGroup& group : groups)
    if (group.name == body) return part == group.parts.front();
  return part == body;
}

/// The text of scene.toml: parts with their poses and files, groups, and the proposed steps.
std::string importedSceneText(const scenes::ImportedCad& cad, const std::vector<std::string>& read,
                              const ImportAnswer& answer) {
  const std::vector<scenes::PartGroup>& groups = answer.groups;
  const std::vector<scenes::Fastener>& fasteners = answer.fasteners;
  scenes::Scene scene = scenes::sceneOf(cad);
  for (std::size_t i = 0, next = 0; i < scene.parts.size() && next < fasteners.size(); ++i)
    if (scene.parts[i].part.name == fasteners[next].part) scene.parts[i].fastener = fasteners[next++].words;
  scenes::Scene united = scene;
  uniteGroups(united, groups);
  const Proposal proposal = propose(united.parts);
  for (scenes::ScenePart& part : scene.parts) part.is_fixed = isOf(part.part.name, proposal.fixed, groups);
  std::vector<std::string> files;
  for (const ImportedPartAnswer& part : answer.parts) files.push_back(part.file);
  std::string out = sceneText(
      scene, files,
      "From " + listedFiles(read) + R"(. Lengths and meshes are in metres; write "5mm" for millimetres.)");
  out += "\n";
  for (const scenes::PartGroup& group : groups) out += groupText(group);
  if (!proposal.steps.empty())
    out +=
        R"(# A proposal: the largest part is fixed, the others follow upwards along z. Correct the order of the steps, or let
# vps plan find order and paths.
)";
  for (const std::string& name : proposal.steps) out += "[[step]]\npart = " + scenes::tomlText(name) + "\n\n";
  out.pop_back();
  return out;
}

/// Writes a mesh file for each part.
std::vector<ImportedPartAnswer> writeParts(const scenes::ImportedCad& cad, const ImportArguments& given,
                                           const OutputFolder& out) {
  std::vector<ImportedPartAnswer> written;
  std::set<std::string> taken;
  for (const scenes::ImportedPart& part : cad.parts) {
    throwIfStopped();
    const std::string file = partFileName(part.name, meshExtension(part.mesh, part.face_colors), taken);
    requireNotRead((fs::path(given.out) / file).string(), given.files);
    out.write(file, meshBytes(part.mesh, part.face_colors));
    written.push_back({part.name, file, part.mesh.triangles.size(), checkMesh(part.mesh).isClosed(),
                       bounds(part.mesh).size()});
  }
  return written;
}

std::string writtenPartTable(const std::vector<ImportedPartAnswer>& parts) {
  Table table({"<part", "triangles", "<closed", "size [mm]", "<file"});
  for (const ImportedPartAnswer& part : parts)
    table.add({part.name, std::to_string(part.triangles), part.is_closed ? "yes" : "no",
               fixed(part.size_m.x() * 1e3, 2) + " x " + fixed(part.size_m.y() * 1e3, 2) + " x " +
                   fixed(part.size_m.z() * 1e3, 2),
               part.file});
  return table.text();
}

int runImport(const ImportArguments& given) {
  for (const std::string& file : given.files) requireCadFile(file);
  const scenes::ImportSettings settings = importSettingsFrom(given.cad, kMostTriangles);
  std::error_code error;
  if (!given.is_forced && fs::exists(fs::path(given.out) / "scene.toml", error))
    throw LoadError(given.out, "",
                    "has a scene.toml already; choose another folder, or replace it with --force");
  OutputFolder out(given.out);
  OutputFile json(given.json, given.files);

  ProgressBar bar;
  const scenes::TimeLimit limit{settings.most_s};
  scenes::ImportedCad cad = importedCad(given.files, settings, given.cad, bar.progress());
  const std::vector<scenes::Fastener> fasteners = scenes::findFasteners(
      scenes::drawnParts(cad), scenes::withTimeLimit(bar.progress(), limit, given.files.front()));
  bar.clear();
  const std::vector<scenes::PartGroup> groups = groupsOf(cad, given.cad);

  ImportAnswer answer{cad.file, cad.format, {}, groups, fasteners, cad.warnings};
  answer.parts = writeParts(cad, given, out);
  out.write("scene.toml", importedSceneText(cad, given.files, answer));
  out.commit();
  json.write(toJson(answer));

  std::fputs((writtenPartTable(answer.parts) + fastenerText(fasteners)).c_str(), stdout);
  for (const std::string& warning : cad.warnings)
    warn(given.files.size() > 1 ? warning : cad.file + ": " + warning);
  std::printf("%s from %s; scene: %s/scene.toml\n", scenes::counted(cad.parts.size(), "part").c_str(),
              cad.format.c_str(), given.out.c_str());
  return kGood;
}

}  // namespace

std::function<int()> addImport(CLI::App& command) {
  const auto given = std::make_shared<ImportArguments>();
  command
      .add_option("cad", given->files,
                  "STEP, IGES, glTF, STL, OBJ, PLY, Inventor, ...; several files share one frame")
      ->required()
      ->type_name("CAD");
  command.add_option("-o,--out", given->out, "folder for scene.toml and meshes")
      ->required()
      ->type_name("DIR");
  addCadOptions(command, given->cad);
  addCacheOptions(command, given->cad.cache);
  command.add_flag("--force", given->is_forced, "replace a scene.toml that exists");
  addJsonOption(command, given->json);
  return [given] { return runImport(*given); };
}

}  // namespace vps::viewer
