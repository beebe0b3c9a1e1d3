// SPDX-License-Identifier: BSD-3-Clause
// vps import: makes a scene from a CAD file: parts as meshes, poses and proposed steps.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "command.h"
#include "file_kind.h"
#include "json_out.h"
#include "output.h"
#include "part_file_name.h"
#include "progress_bar.h"
#include "scene_arguments.h"
#include "stl.h"
#include "table.h"
#include "terminal.h"
#include "vps/load_error.h"
#include "vps/mesh_repair.h"
#include "vps_scenes/import.h"
#include "vps_scenes/plan.h"
#include "vps_scenes/scene_text.h"

namespace vps::viewer::inline v0 {

namespace {

namespace fs = std::filesystem;

struct ImportArguments {
  std::vector<std::string> cad;
  std::string out, units, up, deflection, json;
  bool is_forced = false;  ///< replaces an existing scene.toml
};

Box boundsAt(const scenes::ImportedPart& part) {
  Box box;
  for (const Vec3& p_P : part.mesh.vertices) box.add(part.X_WP * p_P);
  return box;
}

/// A procedure for the user to correct: the largest part is fixed, the others follow from the lowest upwards.
struct Proposal {
  std::size_t fixed = 0;
  std::vector<std::size_t> steps;
};

Proposal propose(const std::vector<scenes::ImportedPart>& parts) {
  std::vector<double> volume_m3, foot_m;
  for (const scenes::ImportedPart& part : parts) {
    const Box box = boundsAt(part);
    volume_m3.push_back(box.size().prod());
    foot_m.push_back(box.min.z());
  }
  Proposal proposal;
  proposal.fixed =
      static_cast<std::size_t>(std::max_element(volume_m3.begin(), volume_m3.end()) - volume_m3.begin());
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (i != proposal.fixed) proposal.steps.push_back(i);
  std::stable_sort(proposal.steps.begin(), proposal.steps.end(),
                   [&](std::size_t a, std::size_t b) { return foot_m[a] < foot_m[b]; });
  return proposal;
}

std::string textOf(const scenes::ImportedCad& cad, const std::vector<std::string>& read,
                   const std::vector<ImportedPartAnswer>& parts) {
  scenes::Scene scene = scenes::sceneOf(cad);
  const Proposal proposal = propose(cad.parts);
  scene.parts[proposal.fixed].is_fixed = true;
  std::string from;
  for (const std::string& file : read) from += (from.empty() ? "" : ", ") + scenes::tomlText(file);
  std::vector<std::string> files;
  for (const ImportedPartAnswer& part : parts) files.push_back(part.file);
  std::string out = sceneText(
      scene, files, "From " + from + R"(. Lengths and meshes are in metres; write "5mm" for millimetres.)");
  if (proposal.steps.empty()) return out;
  out +=
      R"(
# A proposal: the largest part is fixed, the others follow upwards along z. Correct the order of the steps, or let
# vps plan find order and ways.
)";
  for (const std::size_t i : proposal.steps)
    out += "[[step]]\npart = " + scenes::tomlText(parts[i].name) + "\n\n";
  out.pop_back();
  return out;
}

int runImport(const ImportArguments& given) {
  for (const std::string& file : given.cad) requireCadFile(file);
  scenes::ImportSettings settings;
  settings.unit_m = unitFrom(given.units);
  if (!given.deflection.empty())
    settings.deflection_m = scenes::lengthFromText(given.deflection, "--deflection");
  if (!(settings.deflection_m > 0))
    throw LoadError("", "", "--deflection is " + given.deflection + "; expected more than 0");
  if (!given.up.empty()) {
    settings.up = scenes::axisFromText(given.up);
    if (!settings.up)
      throw LoadError("", "", "--up is '" + given.up + "'; expected one of: x, -x, y, -y, z, -z");
  }
  std::error_code error;
  if (!given.is_forced && fs::exists(fs::path(given.out) / "scene.toml", error))
    throw LoadError(given.out, "",
                    "has a scene.toml already; choose another folder, or replace it with --force");
  OutputFolder out(given.out);
  OutputFile json(given.json, given.cad);
  ProgressBar bar;
  scenes::ImportedCad cad = scenes::importCad(given.cad, settings, bar.progress());
  if (cad.format.find("Inventor") != std::string::npos && !settings.up)
    cad.warnings.emplace_back(
        "z is taken to be up, though y often is in Inventor files; --up y turns the parts, --up z says that "
        "z is "
        "right");

  ImportAnswer answer{cad.file, cad.format, {}, cad.warnings};
  std::set<std::string> taken;
  Table table({"<part", "triangles", "<closed", "size [mm]", "<file"});
  for (const scenes::ImportedPart& part : cad.parts) {
    throwIfStopped();
    const ImportedPartAnswer row{part.name, partFileName(part.name, taken), part.mesh.triangles.size(),
                                 checkMesh(part.mesh).isClosed(), bounds(part.mesh).size()};
    requireNotRead((fs::path(given.out) / row.file).string(), given.cad);
    out.write(row.file, stlBytes(part.mesh));
    table.add({row.name, std::to_string(row.triangles), row.is_closed ? "yes" : "no",
               fixed(row.size_m.x() * 1e3, 2) + " x " + fixed(row.size_m.y() * 1e3, 2) + " x " +
                   fixed(row.size_m.z() * 1e3, 2),
               row.file});
    answer.parts.push_back(row);
  }
  out.write("scene.toml", textOf(cad, given.cad, answer.parts));
  out.commit();
  json.write(toJson(answer));
  bar.clear();

  std::fputs(table.text().c_str(), stdout);
  for (const std::string& warning : cad.warnings)
    warn(given.cad.size() > 1 ? warning : cad.file + ": " + warning);
  std::printf("%zu parts from %s; scene: %s/scene.toml\n", cad.parts.size(), cad.format.c_str(),
              given.out.c_str());
  return kGood;
}

}  // namespace

void addImport(CommandLine& line) {
  const auto given = std::make_shared<ImportArguments>();
  CLI::App& command =
      addCommand(line, "import", "makes a scene from CAD files: parts, poses and proposed steps",
                 "vps import assembly.step -o my_scene", [given] { return runImport(*given); });
  command
      .add_option("cad", given->cad,
                  "STEP, IGES, glTF, STL, OBJ, PLY, Inventor, ...; several files share one frame")
      ->required()
      ->type_name("CAD");
  command.add_option("-o,--out", given->out, "folder for scene.toml and meshes")
      ->required()
      ->type_name("DIR");
  addUnitsOption(command, given->units);
  command.add_option("--up", given->up, "the file's axis that is up and becomes z: x, -x, y, -y, z or -z")
      ->type_name("AXIS");
  command.add_option("--deflection", given->deflection,
                     "greatest distance between curved faces and their triangles, with unit");
  command.add_flag("--force", given->is_forced, "replace a scene.toml that exists");
  addJsonOption(command, given->json);
}

}  // namespace vps::viewer::inline v0
