// SPDX-License-Identifier: BSD-3-Clause
// vps import: CAD to a scene: parts as meshes, poses, steps proposed.
#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <set>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "table.h"
#include "terminal.h"
#include "vps/load_error.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;

/// A part's mesh as binary STL: float metres, which hold 1 m to 0.06 um. Equal corners are equal to the bit,
/// so that they weld again. (Binary PLY is smaller, but Debian 12's assimp takes a first data byte of 0x0A
/// for a line end.)
std::string stlOf(const Mesh& mesh) {
  static_assert(std::endian::native == std::endian::little, "STL is little endian");
  std::string out = "metres";
  out.resize(80, ' ');
  const auto put = [&out](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int axis = 0; axis < 3; ++axis) put(0.0f);  // the normal: readers take it from the winding
    for (const std::uint32_t vertex : triangle)
      for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(mesh.vertices[vertex][axis]));
    put(std::uint16_t{0});
  }
  return out;
}

/// A file name out of a part's name, unlike all given so far.
std::string fileNameOf(const std::string& name, std::set<std::string>& taken) {
  std::string stem;
  for (const unsigned char c : name)
    stem += std::isalnum(c) || c == '-' || c == '_' ? static_cast<char>(c) : '_';
  if (stem.empty()) stem = "part";
  std::string file = stem + ".stl";
  for (int i = 2; !taken.insert(file).second; ++i) file = stem + "_" + std::to_string(i) + ".stl";
  return file;
}

/// A TOML basic string.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const unsigned char c : text) {
    char escape[8];
    if (c == '"' || c == '\\') {
      out += '\\';
      out += static_cast<char>(c);
    } else if (c < 0x20 || c == 0x7F) {
      std::snprintf(escape, sizeof escape, "\\u%04X", c);
      out += escape;
    } else {
      out += static_cast<char>(c);
    }
  }
  return out + "\"";
}

std::string poseText(const Pose& pose) {
  const Quat q = pose.quaternion();
  // Twelve digits say a picometre in a metre; more would only show the noise of the file's own arithmetic.
  const auto n = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", value == 0 ? 0.0 : value);
    return std::string(text);
  };
  return "{position = [" + n(pose.p.x()) + ", " + n(pose.p.y()) + ", " + n(pose.p.z()) +
         "], rotation_xyzw = [" + n(q.x()) + ", " + n(q.y()) + ", " + n(q.z()) + ", " + n(q.w()) + "]}";
}

Box boundsAt(const scenes::ImportedPart& part) {
  Box box;
  for (const Vec3& p_P : part.mesh.vertices) box.add(part.X_WP * p_P);
  return box;
}

/// What a person should check first: the largest part stays, the others come in from below upwards.
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

std::string sceneText(const scenes::ImportedCad& cad, const std::vector<ImportedPartAnswer>& parts,
                      const Proposal& proposal) {
  std::string out =
      "# From " + quoted(cad.file) + R"(. Lengths and meshes are in metres; write "5mm" for millimetres.
unit = "m"

)";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out += "[[part]]\nname = " + quoted(parts[i].name) + "\nfile = " + quoted(parts[i].file) + "\n";
    if (i == proposal.fixed) out += "fixed = true\n";
    out += "pose = " + poseText(cad.parts[i].X_WP) + "\n\n";
  }
  if (!proposal.steps.empty())
    out +=
        R"(# Proposed: upwards along z, the largest part fixed. Put the steps in order, and say each fit's diametral
# clearance (clearance = "20um").
)";
  for (const std::size_t i : proposal.steps) out += "[[step]]\npart = " + quoted(parts[i].name) + "\n\n";
  out.pop_back();
  return out;
}

}  // namespace

int runImport(const ImportArguments& given) {
  scenes::ImportSettings settings;
  if (!given.units.empty()) {
    settings.unit_m = scenes::unitFromText(given.units);
    if (!settings.unit_m)
      throw LoadError("", "", "--units is '" + given.units + "'; expected one of: mm, cm, m, um, inch");
  }
  if (!given.deflection.empty())
    settings.deflection_m = scenes::lengthFromText(given.deflection, "--deflection");
  if (!(settings.deflection_m > 0))
    throw LoadError("", "", "--deflection is " + given.deflection + "; expected more than 0");
  std::error_code error;
  if (!given.is_forced && fs::exists(fs::path(given.out) / "scene.toml", error))
    throw LoadError(given.out, "",
                    "has a scene.toml already; choose another folder, or --force to write over it");
  OutputFolder out(given.out);
  OutputFile json(given.json, {given.cad});
  ProgressBar bar;
  const scenes::ImportedCad cad = scenes::importCad(given.cad, settings, bar.progress());

  ImportAnswer answer{given.cad, cad.format, {}, cad.warnings};
  std::set<std::string> taken;
  Table table({"<part", "triangles", "<closed", "size [mm]", "<file"});
  for (const scenes::ImportedPart& part : cad.parts) {
    throwIfStopped();
    const ImportedPartAnswer row{part.name, fileNameOf(part.name, taken), part.mesh.triangles.size(),
                                 checkMesh(part.mesh).isClosed(), bounds(part.mesh).size()};
    requireNotRead((fs::path(given.out) / row.file).string(), {given.cad});
    out.write(row.file, stlOf(part.mesh));
    table.add({row.name, std::to_string(row.triangles), row.is_closed ? "yes" : "no",
               fixed(row.size_m.x() * 1e3, 2) + " x " + fixed(row.size_m.y() * 1e3, 2) + " x " +
                   fixed(row.size_m.z() * 1e3, 2),
               row.file});
    answer.parts.push_back(row);
  }
  out.write("scene.toml", sceneText(cad, answer.parts, propose(cad.parts)));
  out.commit();
  json.write(toJson(answer));
  bar.clear();

  std::fputs(table.text().c_str(), stdout);
  for (const std::string& warning : cad.warnings) warn(given.cad + ": " + warning);
  std::printf("%zu parts from %s; scene: %s/scene.toml\n", cad.parts.size(), cad.format.c_str(),
              given.out.c_str());
  return kGood;
}

}  // namespace vps::viewer
