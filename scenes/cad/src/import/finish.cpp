// SPDX-License-Identifier: BSD-3-Clause
// Turns a reader's result into parts: metres, rigid poses, welded meshes, unique names, warnings.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "core/equal_meshes.h"
#include "core/valid_text.h"
#include "import/part_names.h"
#include "import/readers.h"
#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps/stoppable.h"
#include "vps_scenes/cad/colors.h"

namespace vps::scenes::import {
namespace {

void flip(Mesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// Applies the part of X_WP that is not rigid (scale, mirror, shear) to the vertices, and the unit to
/// vertices and pose.
ImportedPart inMetres(const RawPart& raw, double unit_m) {
  ImportedPart part;
  part.name = raw.name;
  part.color = raw.color;
  part.face_colors = raw.face_colors;
  part.mesh = raw.mesh;
  part.deflection_m = raw.deviation_m;
  part.note = raw.note;
  part.within = raw.within;
  // Smaller values are ignored: for two parts together they stay below 0.1 um, the accuracy of an overlap's
  // depth in `vps check`.
  constexpr double kLeastRounding_m = 0.05e-6;
  if (const double rounding_m = raw.rounding * unit_m; rounding_m > kLeastRounding_m)
    part.rounding_m = rounding_m;
  const Mat3 M = raw.X_WP.linear();
  const double scale = std::cbrt(std::abs(M.determinant()));
  Mat3 R = Mat3::Identity(), rest = M;
  if (scale > 0 && M.determinant() > 0) {
    const Mat3 candidate = M / scale;
    // 1e-5: Inventor and glTF store rotations as floats.
    if ((candidate * candidate.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-5) {
      R = Quat(candidate).normalized().toRotationMatrix();
      rest = Mat3::Identity() * (std::abs(scale - 1) < 1e-6 ? 1.0 : scale);
    }
  }
  part.X_WP = Pose(R, Vec3(raw.X_WP.translation() * unit_m));
  for (Vec3& p : part.mesh.vertices) p = rest * p * unit_m;
  if (rest.determinant() < 0) flip(part.mesh);
  return part;
}

/// Welds with the least tolerance that closes the mesh, or else with the tolerance that leaves the fewest
/// open edges. Exporters round to float (1e-7 of the size) or to CAD tolerance (1 um at most).
WeldedMesh weldedToClose(const Mesh& mesh, MeshReport& report) {
  const double size_m = bounds(mesh).size().norm();
  WeldedMesh best;
  for (const double relative : {0.0, 1e-7, 1e-6, 1e-5}) {
    WeldedMesh candidate = weldedWithSources(mesh, std::min(relative * size_m, 1e-6));
    const MeshReport found = checkMesh(candidate.mesh);
    if (relative == 0 || found.open_edges < report.open_edges) {
      best = std::move(candidate);
      report = found;
    }
    if (report.open_edges == 0) break;
  }
  return best;
}

/// The connected components of a mesh, each with the indices of its triangles in the mesh. Triangles with a
/// common vertex are connected.
std::vector<WeldedMesh> shells(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::map<std::uint32_t, std::size_t> shell_of;
  std::vector<WeldedMesh> out;
  std::vector<std::uint32_t> index(mesh.vertices.size(), UINT32_MAX);
  for (std::uint32_t number = 0; number < mesh.triangles.size(); ++number) {
    auto triangle = mesh.triangles[number];
    const auto [it, is_new] = shell_of.try_emplace(root(triangle[0]), out.size());
    if (is_new) out.emplace_back();
    Mesh& shell = out[it->second].mesh;
    out[it->second].sources.push_back(number);
    for (std::uint32_t& i : triangle) {
      if (index[i] == UINT32_MAX) {
        index[i] = std::uint32_t(shell.vertices.size());
        shell.vertices.push_back(mesh.vertices[i]);
      }
      i = index[i];
    }
    shell.triangles.push_back(triangle);
  }
  return out;
}

bool hasVertex(const ImportedPart& part, const Vec3& p_W) {
  return std::any_of(part.mesh.vertices.begin(), part.mesh.vertices.end(),
                     [&](const Vec3& p) { return (part.X_WP * p - p_W).squaredNorm() < 1e-12; });
}

/// Replaces open shapes that together form closed surfaces by the bodies that these surfaces bound, in the
/// assembly's frame.
void joinShapes(std::vector<ImportedPart>& parts, Shapes meaning) {
  std::vector<ImportedPart> kept, open;
  std::size_t open_edges = 0;
  for (ImportedPart& part : parts) {
    pollStop();
    MeshReport report;
    weldedToClose(part.mesh, report);
    open_edges += report.open_edges;
    (report.open_edges == 0 ? kept : open).push_back(std::move(part));
  }
  WeldedMesh all;
  FaceColors colors;
  MeshReport joined;
  double rounding_m = 0;
  for (const ImportedPart& part : open) rounding_m = std::max(rounding_m, part.rounding_m);
  for (const ImportedPart& part : open) {
    append(all.mesh, transformed(part.mesh, part.X_WP));
    append(colors, part.mesh.triangles.size(), part.face_colors, part.color);
  }
  if (open.size() > 1) {
    all = weldedToClose(all.mesh, joined);
    colors = ofTriangles(colors, all.sources);
  }
  if (open.size() < 2 || joined.open_edges >= open_edges) {
    kept.insert(kept.end(), std::make_move_iterator(open.begin()), std::make_move_iterator(open.end()));
  } else if (meaning == Shapes::BoundOne) {
    kept.push_back({"", std::move(all.mesh), Pose(), open.front().color});
    kept.back().rounding_m = rounding_m;
    kept.back().face_colors = std::move(colors);
  } else {
    for (WeldedMesh& shell : shells(all.mesh)) {
      // A body gets name and colour from the shape with the body's first vertex.
      const Vec3 p_W = shell.mesh.vertices.front();
      const auto source = std::find_if(open.begin(), open.end(),
                                       [&](const ImportedPart& part) { return hasVertex(part, p_W); });
      const ImportedPart& like = source == open.end() ? open.front() : *source;
      kept.push_back({like.name, std::move(shell.mesh), Pose(), like.color});
      kept.back().rounding_m = rounding_m;
      kept.back().face_colors = ofTriangles(colors, shell.sources);
    }
  }
  parts = std::move(kept);
}

double farthest_m(const ImportedPart& part) {
  double farthest_m = part.X_WP.p.norm();
  for (const Vec3& p : part.mesh.vertices)
    farthest_m = std::max({farthest_m, p.norm(), (part.X_WP * p).norm()});
  return farthest_m;
}

void describe(const ImportedPart& part, const MeshReport& report, std::vector<std::string>& warnings) {
  if (!part.note.empty()) warnings.push_back("part '" + part.name + "': " + part.note);
  const auto warn = [&](std::size_t count, const std::string& text) {
    if (count > 0) warnings.push_back("part '" + part.name + "': " + std::to_string(count) + " " + text);
  };
  warn(report.open_edges, "open edges: the surface has holes, inside and outside are uncertain near them");
  warn(report.non_manifold_edges, "edges with more than two triangles: bodies touch or surfaces cross there");
  warn(report.flipped_edges, "edges between facets of opposite orientation: some facets face inwards");
  warn(report.degenerate_triangles, "triangles without area");
  constexpr double kNamed_m = 1e-6;  // the default deflection of import
  if (part.rounding_m > kNamed_m) {
    char text[320];
    std::snprintf(text, sizeof text,
                  "part '%s': is %.3g m from the origin of its file, whose 32-bit numbers round by up to "
                  "%.2g um there, which counts as an error of the part; move the assembly to the origin and "
                  "export it again, or export STEP",
                  part.name.c_str(), farthest_m(part), 1e6 * part.rounding_m);
    warnings.emplace_back(text);
  }
  const double extent_m = bounds(part.mesh).size().maxCoeff();
  if (extent_m > 10 || extent_m < 1e-3) {
    char text[160];
    std::snprintf(text, sizeof text, "part '%s': is %.3g m large; check the unit", part.name.c_str(),
                  extent_m);
    warnings.emplace_back(text);
  }
}

}  // namespace

namespace {

/// A welded mesh with all facets outward, as a part has it.
struct FinishedMesh : WeldedMesh {
  MeshReport report;
  bool is_turned = false;
};

FinishedMesh finished(const Mesh& mesh) {
  FinishedMesh out;
  static_cast<WeldedMesh&>(out) = weldedToClose(mesh, out.report);
  out.is_turned =
      !out.mesh.triangles.empty() && out.report.isClosed() && massProperties(out.mesh).volume_m3 < 0;
  if (out.is_turned) flip(out.mesh);
  return out;
}

/// Welds the meshes of all parts on all cores; equal meshes are welded only once.
void weldAll(ImportedCad& cad, StoppableWork& work) {
  EqualMeshes known;
  std::vector<std::size_t> own, source(cad.parts.size());
  for (std::size_t i = 0; i < cad.parts.size(); ++i) {
    source[i] = known.findOrAdd(i, cad.parts[i].mesh, [&](std::size_t k) {
      return isEqualGeometry(cad.parts[k].mesh, cad.parts[i].mesh);
    });
    if (source[i] != EqualMeshes::kNone) continue;
    source[i] = i;
    own.push_back(i);
  }
  std::vector<FinishedMesh> welded(cad.parts.size());
  std::atomic<std::size_t> done = 0;
  onAllCores(own.size(), [&](std::size_t k) {
    welded[own[k]] = finished(cad.parts[own[k]].mesh);
    work.report("welding the meshes", static_cast<double>(++done) / static_cast<double>(own.size()));
  });
  for (std::size_t i = 0; i < cad.parts.size(); ++i) {
    ImportedPart& part = cad.parts[i];
    const FinishedMesh& of = welded[source[i]];
    part.mesh = of.mesh;
    part.face_colors = ofTriangles(part.face_colors, of.sources);
    simplify(part.face_colors, part.color);
    requireUsable(part.mesh, cad.file, part.name);
    if (of.is_turned)
      cad.warnings.push_back("part '" + part.name + "': was inside out; its facets were reversed");
    describe(part, of.report, cad.warnings);
  }
}

}  // namespace

double floatRounding(const Mesh& mesh, const Eigen::Affine3d& X_WP) {
  constexpr double kRelative = 0x1p-24;  // half of a float's last bit
  double farthest = 0;
  for (const Vec3& p : mesh.vertices) farthest = std::max(farthest, p.squaredNorm());
  const double vertex = kRelative * std::sqrt(farthest);
  if (X_WP.matrix().isIdentity(0)) return vertex;
  // The terms are the roundings of the vertices and of the matrix that multiplies them, and of the
  // translation.
  return 2 * X_WP.linear().norm() * vertex + kRelative * X_WP.translation().norm();
}

std::array<float, 3> linearFromSrgb(const std::array<float, 3>& srgb) {
  std::array<float, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float c = srgb[i];
    linear[i] = static_cast<float>(scenes::linearFromSrgb(static_cast<double>(c)));
  }
  return linear;
}

namespace {

std::string withoutOuterBlanks(const std::string& name) {
  const std::size_t from = std::min(name.find_first_not_of(' '), name.size());
  return name.substr(from, name.find_last_not_of(' ') + 1 - from);
}

}  // namespace

void nameUniquely(std::vector<ImportedPart>& parts, const std::string& fallback) {
  UniqueNames names;
  for (ImportedPart& part : parts) {
    part.name = withoutOuterBlanks(printable(part.name));
    if (part.name.empty()) part.name = fallback;
    part.name = names.unique(part.name);
  }
}

void finish(RawCad raw, ImportedCad& cad, StoppableWork& work) {
  work.report("welding the meshes", 0);
  cad.warnings = std::move(raw.warnings);
  for (const RawPart& part : raw.parts) {
    if (!part.mesh.triangles.empty()) cad.parts.push_back(inMetres(part, raw.unit_m));
  }
  // A shape without area is ignored; a file with no other shapes is an error, reported below.
  const auto isNothing = [](const ImportedPart& part) { return area(part.mesh) == 0; };
  if (!std::all_of(cad.parts.begin(), cad.parts.end(), isNothing)) {
    const std::size_t count = std::erase_if(cad.parts, isNothing);
    if (count > 0) cad.warnings.push_back(std::to_string(count) + " shapes without area were left out");
  }
  if (cad.parts.empty()) throw LoadError(cad.file, "", "holds no surfaces; export solids or meshes");
  for (const ImportedPart& part : cad.parts) {
    requireUsable(part.mesh, cad.file, part.name);
    if (!part.X_WP.isFinite())
      throw LoadError(cad.file, part.name, "its pose is not finite; export it again");
  }
  if (raw.open_shapes != Shapes::AreParts && cad.parts.size() > 1) joinShapes(cad.parts, raw.open_shapes);
  nameUniquely(cad.parts, stem(cad.file));
  weldAll(cad, work);
}

}  // namespace vps::scenes::import
