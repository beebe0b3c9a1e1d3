// SPDX-License-Identifier: BSD-3-Clause
// Repairs meshes for the sign of distances: orientation, duplicates, internal facets and sheets. The file has
// more than 400 lines because its steps share the state of one repair.
#include "vps/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "mesh/mesh_edges.h"
#include "mesh/repair/mesh_faults.h"
#include "mesh/union/shell_nesting.h"
#include "mesh/union/shell_union.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh_distance.h"
#include "vps/stoppable.h"
#include "vps/winding_number.h"

namespace vps {
namespace {

/// Number of sampled facets that classify a whole patch. Assumed: enough for a mean, and fast.
constexpr std::size_t kSamples = 48;
/// Number of rays that classify the sides of open patches, over the whole mesh. Assumed: takes seconds for an
/// unconnected set of 100,000 facets.
constexpr std::size_t kMaxRays = 20000;
/// A patch whose mean winding number differs from 0.5 by at least this is classified as not being surface.
constexpr double kClearly = 0.35;
/// If there are at most this many sheets and walls, they are searched for copies of the surface, at the cost
/// of a winding number of the whole mesh each. Assumed: copies are few.
constexpr std::size_t kMaxCopies = 32;
/// Winding number in a facet's plane above which both sides are clearly inside. The winding number is 0.5
/// more behind the facet and 0.5 less in front, and a threshold of 0.75 leaves a margin of a quarter on both
/// sides.
constexpr double kInternal = 1.25;
/// Winding number in a facet's plane below which both sides are clearly outside, by the same margin.
constexpr double kExternal = -0.25;

/// Facets that are connected by edges of two facets, and therefore must have one orientation.
struct Patch {
  std::vector<std::uint32_t> triangles;
  Box box;
  double volume_m3 = 0;
  bool is_closed = false;  ///< every edge has as many facets in one direction as in the other
};

struct Facet {
  Vec3 center, normal;
  double area_m2 = 0;
};

Facet facetOf(const Mesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3 n = 0.5 * (b - a).cross(c - a);
  const double area_m2 = n.norm();
  return {(a + b + c) / 3, area_m2 > 0 ? Vec3(n / area_m2) : Vec3(Vec3::Zero()), area_m2};
}

/// Six times the volume of the tetrahedron from o to a triangle.
double determinant(const Mesh& mesh, std::uint32_t triangle, const Vec3& o) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
  return a.dot(b.cross(c));
}

/// True if any two of the boxes share a point.
bool haveOverlap(const std::vector<Box>& boxes) {
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!tree.forEachOverlap(boxes, boxes[i], [i](std::uint32_t other) { return other == i; })) return true;
  return false;
}

bool boxesTouch(std::vector<Box> boxes, double touch_m) {
  if (boxes.size() < 2) return false;
  for (Box& box : boxes) box = {box.min.array() - touch_m, box.max.array() + touch_m};
  return haveOverlap(boxes);
}

/// True if all of the given closed and consistently oriented shells face out, and no two shells' boxes
/// overlap or touch.
bool areSound(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of, std::size_t count) {
  std::vector<Box> boxes(count);
  for (std::size_t i = 0; i < shell_of.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) boxes[shell_of[i]].add(mesh.vertices[v]);
  std::vector<double> volume_m3(count, 0);
  for (std::uint32_t i = 0; i < shell_of.size(); ++i)
    volume_m3[shell_of[i]] += determinant(mesh, i, boxes[shell_of[i]].center()) / 6;
  return std::all_of(volume_m3.begin(), volume_m3.end(), [](double v) { return v > 0; }) &&
         !boxesTouch(boxes, touchDistance(mesh));
}

class Repairer {
 public:
  Repairer(Mesh mesh, Crossing crossing) : is_crossing_(crossing == Crossing::Seen), is_single_(false) {
    result_.solid = std::move(mesh);
  }

  RepairedMesh run() {
    edges_ = sortedHalfEdges(mesh());
    std::vector<std::uint32_t> shell_of;
    result_.report = checkMesh(mesh(), edges_, &shell_of);
    if (report().open_edges > 0) closeNarrowCracks(shell_of);
    const bool is_whole = !is_crossing_ && report().isClosed() && report().degenerate_triangles == 0;
    if (is_whole && report().duplicate_triangles == 0 && areSound(mesh(), shell_of, report().shells))
      return finish(true);
    if (std::optional<RepairedMesh> united = unitedShells()) return std::move(*united);
    joined_ = joinFacets(mesh(), edges_, kWidestBetweenCopies);
    const bool has_dropped_copies = dropDuplicates();
    if (has_dropped_copies) edges_ = sortedHalfEdges(mesh());
    if (has_dropped_copies || joined_.open_m > 0) joined_ = joinFacets(mesh(), edges_, kWidestCrack);
    surveyOpenEdges(mesh(), edges_, report());
    findPatches();
    turnClosed();
    if (mayNeedUnion() && haveContact(closedFacets())) report().is_union_incomplete = true;
    is_kept_.assign(mesh().triangles.size(), Keep::Both);
    const bool has_open =
        std::any_of(patches_.begin(), patches_.end(), [](const Patch& p) { return !p.is_closed; });
    if (has_open) {
      turnOpenByWinding();
      turnOpenByRays();
      setAsideWallsAndSheets();
    }
    dropInternalFacets();
    // A mesh whose only faults were turned or duplicate facets is sound now.
    const bool has_dropped = std::find_if(is_kept_.begin(), is_kept_.end(),
                                          [](Keep k) { return k != Keep::Both; }) != is_kept_.end();
    const bool is_sound =
        !is_crossing_ && report().degenerate_triangles == 0 && !has_dropped && isSound() && agreesOnEdges();
    return finish(is_sound);
  }

 private:
  /// Constructor for a repair without a union of shells.
  Repairer(const Mesh& mesh, bool is_single) : is_crossing_(false), is_single_(is_single) {
    result_.solid = mesh;
  }

  enum class Keep : std::uint8_t { Both, Solid, Surface, None };

  /// The union of closed shells, if some of them touch, with the other patches repaired next to it.
  /// Duplicates are tested first: if they are the only fault, they are copies of facets.
  std::optional<RepairedMesh> unitedShells() {
    if (is_crossing_ || is_single_) return std::nullopt;
    std::optional<Mesh> solid = report().degenerate_triangles > 0 ? withoutFlatFacets(mesh()) : mesh();
    if (!solid) return std::nullopt;
    Repairer closed(*solid, true);
    closed.findClosed();
    if (report().duplicate_triangles > 0 && areOnlyCopies(closed)) return std::nullopt;
    std::optional<ShellUnion> found = closed.uniteClosed();
    if (!found) return std::nullopt;
    const Mesh others = closed.otherFacets();
    is_contact_known_ = others.triangles.empty();
    if (found->united_shells == 0) return std::nullopt;
    if (found->mesh.triangles.empty()) {
      report().is_union_incomplete = true;
      return std::nullopt;
    }
    RepairedMesh united = beside(std::move(found->mesh), others);
    united.report = reportOf(closed.report(), united.report);
    united.report.united_shells = found->united_shells;
    united.report.overlapping_shells += found->covered_shells;
    united.report.internal_facets += found->covered_facets;
    return united;
  }

  /// True if the mesh is sound when one facet of each set of duplicates is left out. False if a shell faces
  /// in: back-to-back facets may then be the same surface of two solids rather than a wall between them, so
  /// that none may be lost.
  bool areOnlyCopies(const Repairer& shells) {
    Repairer single(mesh(), true);
    return single.run().is_sound && !(single.has_cancelled_ && shells.hasShellFacingIn());
  }
  [[nodiscard]] bool hasShellFacingIn() const {
    constexpr double kFlat = 1e-9;  // share of the box: rounding error, as of a facet and its copy
    return std::any_of(patches_.begin(), patches_.end(), [](const Patch& p) {
      return p.is_closed && p.volume_m3 < -kFlat * std::pow(p.box.size().norm(), 3);
    });
  }

  /// Repairs the facets that were not united, with the union as one part of the mesh.
  static RepairedMesh beside(Mesh united, const Mesh& others) {
    if (others.triangles.empty()) return {united, united, {}, false};
    const std::size_t count = united.triangles.size();
    append(united, others);
    Repairer all(welded(united), true);
    all.united_facets_ = count;
    RepairedMesh repaired = all.run();
    repaired.is_sound = false;
    return repaired;
  }
  /// Combines the counts of the given mesh with the repairs before and after the union.
  [[nodiscard]] MeshReport reportOf(const MeshReport& before, const MeshReport& after) const {
    MeshReport all = before;
    all.triangles = result_.report.triangles;
    all.degenerate_triangles = result_.report.degenerate_triangles;
    all.joined_corners = result_.report.joined_corners + after.joined_corners;
    all.joined_m = std::max(result_.report.joined_m, after.joined_m);
    all.holes = after.holes, all.t_junctions = after.t_junctions;
    all.flipped_facets += after.flipped_facets, all.turned_shells += after.turned_shells;
    all.overlapping_shells = after.overlapping_shells, all.internal_facets = after.internal_facets;
    all.sheet_facets = after.sheet_facets, all.is_union_incomplete = after.is_union_incomplete;
    return all;
  }

  /// Finds patches, and which of them are closed and without cracks.
  void findClosed() {
    edges_ = sortedHalfEdges(mesh());
    result_.report = checkMesh(mesh(), edges_);
    joined_ = joinFacets(mesh(), edges_, kWidestBetweenCopies);
    findPatches();
    markOpen(edges_);  // cracks stay open in the union
  }
  /// Call after findClosed(). Turns shells that face in. Returns nothing if there are no two closed shells
  /// whose boxes touch.
  std::optional<ShellUnion> uniteClosed() {
    if (!boxesTouch(boxesOfClosed(), touchDistance(mesh()))) return std::nullopt;
    turnClosed();
    const ShellFacets closed = closedFacets();
    return unite(closed.mesh, closed.shell_of);
  }

  struct ShellFacets {
    Mesh mesh;
    std::vector<std::uint32_t> shell_of;  // by triangle
  };
  static bool haveContact(const ShellFacets& facets) {
    return facets.mesh.triangles.size() > 1 && vps::haveContact(facets.mesh, facets.shell_of);
  }

  /// The facets of closed patches that have area; the facets of an earlier union count as one shell.
  ShellFacets closedFacets() {
    ShellFacets out{{mesh().vertices, {}}, {}};
    std::vector<std::uint32_t> number(patches_.size() + 1, UINT32_MAX);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < patch_of_.size(); ++i) {
      if (!patches_[patch_of_[i]].is_closed || !(facetOf(mesh(), i).area_m2 > 0)) continue;
      std::uint32_t& shell = number[i < united_facets_ ? patches_.size() : patch_of_[i]];
      if (shell == UINT32_MAX) shell = count++;
      out.mesh.triangles.push_back(mesh().triangles[i]);
      out.shell_of.push_back(shell);
    }
    return out;
  }
  [[nodiscard]] Mesh otherFacets() {
    Mesh others = {mesh().vertices, {}};
    for (std::uint32_t i = 0; i < patch_of_.size(); ++i)
      if (!patches_[patch_of_[i]].is_closed) others.triangles.push_back(mesh().triangles[i]);
    return others;
  }
  /// True if the boxes of closed shells that were not united touch.
  bool mayNeedUnion() {
    if (is_crossing_ || is_contact_known_ || report().is_union_incomplete) return false;
    if (is_single_ && united_facets_ == 0) return false;
    return boxesTouch(boxesOfClosed(), touchDistance(mesh()));
  }

  Mesh& mesh() { return result_.solid; }
  MeshReport& report() { return result_.report; }

  void closeNarrowCracks(std::vector<std::uint32_t>& shell_of) {
    ClosedCracks closed = closeCracks(mesh(), edges_);
    if (closed.corners == 0) return;
    mesh() = std::move(closed.mesh);
    edges_ = sortedHalfEdges(mesh());
    result_.report = checkMesh(mesh(), edges_, &shell_of);
    report().joined_corners = closed.corners;
    report().joined_m = closed.widest_m;
  }

  void flip(std::uint32_t triangle) {
    std::swap(mesh().triangles[triangle][1], mesh().triangles[triangle][2]);
    is_flipped_[triangle] ^= 1;
  }
  void flip(Patch& patch) {
    for (const std::uint32_t i : patch.triangles) flip(i);
    patch.volume_m3 = -patch.volume_m3;
    ++report().turned_shells;
  }

  [[nodiscard]] bool isSound() const {
    const auto facesOut = [](const Patch& p) { return p.is_closed && p.volume_m3 > 0; };
    const std::vector<Box> boxes = boxesOfClosed();
    return std::all_of(patches_.begin(), patches_.end(), facesOut) && !haveOverlap(boxes);
  }
  [[nodiscard]] std::vector<Box> boxesOfClosed() const {
    std::vector<Box> boxes;
    for (const Patch& patch : patches_)
      if (patch.is_closed) boxes.push_back(patch.box);
    return boxes;
  }

  /// True if every edge has two triangles that agree.
  bool agreesOnEdges() {
    bool agrees = true;
    forEachEdge(edges_, [&](std::span<const HalfEdge> same) {
      agrees = agrees && same.size() == 2 && isForward(same[0]) != isForward(same[1]);
    });
    return agrees;
  }

  bool dropDuplicates() {
    if (report().duplicate_triangles == 0 && report().open_edges == 0) return false;
    const std::vector<std::uint8_t> is_dropped = findDuplicates(joined_.triangles, joined_.edges);
    const auto count = static_cast<std::size_t>(std::count(is_dropped.begin(), is_dropped.end(), 1));
    if (count == 0) return false;
    std::size_t copies = 0;
    forEachTwin(joined_.triangles, [&](std::span<const Twin> same) {
      if (!hasRepeatedCorner(same[0].corners)) copies += same.size() - 1;
    });
    has_cancelled_ = count > copies;
    report().duplicate_triangles = std::max(report().duplicate_triangles, count);
    std::size_t next = 0;
    for (std::size_t i = 0; i < is_dropped.size(); ++i)
      if (is_dropped[i] == 0) mesh().triangles[next++] = mesh().triangles[i];
    mesh().triangles.resize(next);
    return true;
  }

  /// Turns facets so that their orientations agree within each patch, and turns patches that cracks separate
  /// so that they agree with each other; the minority is turned.
  void findPatches() {
    const std::size_t count = mesh().triangles.size();
    // Two facets that share an edge need not be neighbours: they may be copies of one facet, if an odd number
    // of facets ends at that edge.
    std::vector<std::array<std::uint8_t, 3>> has_copy(count, {0, 0, 0});
    forEachEdge(joined_.edges, [&](std::span<const HalfEdge> same) {
      if (same.size() > 1 && same.size() % 2 == 1)
        for (const HalfEdge& e : same) has_copy[e.triangle][e.side] = 1;
    });
    std::vector<std::array<std::uint32_t, 3>> across(
        count, {UINT32_MAX, UINT32_MAX, UINT32_MAX});  // triangle * 2 + disagrees
    forEachEdge(edges_, [&](std::span<const HalfEdge> same) {
      if (is_single_ && same.size() > 2) pairInOrder(same, across);
      if (same.size() != 2 || has_copy[same[0].triangle][same[0].side] != 0) return;
      const std::uint32_t disagrees = same[0].is_forward == same[1].is_forward;
      across[same[0].triangle][same[0].side] = 2 * same[1].triangle + disagrees;
      across[same[1].triangle][same[1].side] = 2 * same[0].triangle + disagrees;
    });
    std::vector<std::vector<std::uint32_t>> parts;  // sets of triangles that edges connect
    patch_of_.assign(count, UINT32_MAX);
    is_flipped_.assign(count, 0);
    std::vector<std::uint8_t> is_turned(count, 0);
    StridedPoll poll;
    for (std::uint32_t seed = 0; seed < count; ++seed) {
      if (patch_of_[seed] != UINT32_MAX) continue;
      const auto id = static_cast<std::uint32_t>(parts.size());
      std::vector<std::uint32_t>& part = parts.emplace_back(1, seed);
      patch_of_[seed] = id;
      for (std::size_t next = 0; next < part.size(); ++next, poll()) {
        const std::uint32_t i = part[next];
        for (const std::uint32_t side : across[i]) {
          if (side == UINT32_MAX || patch_of_[side / 2] != UINT32_MAX) continue;
          patch_of_[side / 2] = id;
          is_turned[side / 2] = is_turned[i] ^ static_cast<std::uint8_t>(side & 1);
          part.push_back(side / 2);
        }
      }
    }
    const LinkedPatches linked = linkPatches(mesh(), joined_.edges, patch_of_, is_turned);
    patches_.clear();
    for (std::size_t id = 0; id < parts.size(); ++id) {
      const std::uint32_t group = linked.group_of[id];
      if (group == patches_.size()) patches_.emplace_back();
      std::vector<std::uint32_t>& all = patches_[group].triangles;
      all.insert(all.end(), parts[id].begin(), parts[id].end());
      for (const std::uint32_t i : parts[id]) patch_of_[i] = group, is_turned[i] ^= linked.is_opposed[id];
    }
    const auto countTurned = [&](const std::vector<std::uint32_t>& triangles) {
      return static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(),
                                                    [&](std::uint32_t i) { return is_turned[i] != 0; }));
    };
    for (const Patch& patch : patches_)
      if (2 * countTurned(patch.triangles) > patch.triangles.size())
        for (const std::uint32_t i : patch.triangles) is_turned[i] ^= 1;
    for (const std::vector<std::uint32_t>& part : parts) {
      const std::size_t turned = countTurned(part);
      const bool is_shell = 2 * turned > part.size();
      report().turned_shells += is_shell;
      report().flipped_facets += is_shell ? part.size() - turned : turned;
      for (const std::uint32_t i : part)
        if (is_turned[i] != 0) flip(i);
    }
    measurePatches();
  }

  /// Pairs facets at an edge that several shells share: the facets of a shell follow each other in the list.
  static void pairInOrder(std::span<const HalfEdge> same, std::vector<std::array<std::uint32_t, 3>>& across) {
    std::vector<const HalfEdge*> forward, backward;
    for (const HalfEdge& e : same) (e.is_forward ? forward : backward).push_back(&e);
    if (forward.size() != backward.size()) return;
    for (std::size_t i = 0; i < forward.size(); ++i) {
      across[forward[i]->triangle][forward[i]->side] = 2 * backward[i]->triangle;
      across[backward[i]->triangle][backward[i]->side] = 2 * forward[i]->triangle;
    }
  }

  void measurePatches() {
    for (Patch& patch : patches_) {
      patch.is_closed = true;
      for (const std::uint32_t i : patch.triangles)
        for (const std::uint32_t v : mesh().triangles[i]) patch.box.add(mesh().vertices[v]);
      const Vec3 o = patch.box.center();
      for (const std::uint32_t i : patch.triangles) patch.volume_m3 += determinant(mesh(), i, o) / 6;
    }
    markOpen(joined_.edges);
  }

  /// Marks a patch as not closed if one of its edges has more facets in one direction than in the other.
  void markOpen(const std::vector<HalfEdge>& edges) {
    std::vector<std::pair<std::uint32_t, int>> uses;  // of an edge: the patch, and the direction of the side
    forEachEdge(edges, [&](std::span<const HalfEdge> same) {
      uses.clear();
      for (const HalfEdge& e : same) uses.emplace_back(patch_of_[e.triangle], isForward(e) ? 1 : -1);
      std::sort(uses.begin(), uses.end());
      for (std::size_t i = 0; i < uses.size();) {
        const std::uint32_t patch = uses[i].first;
        int net = 0;
        for (; i < uses.size() && uses[i].first == patch; ++i) net += uses[i].second;
        if (net != 0) patches_[patch].is_closed = false;
      }
    });
  }

  /// The direction in the triangle as it is now; the half-edge holds the direction before any turning.
  [[nodiscard]] bool isForward(const HalfEdge& e) const {
    return e.is_forward != (is_flipped_[e.triangle] != 0);
  }

  /// Closed patches, in order of descending volume.
  [[nodiscard]] std::vector<std::size_t> closedByVolume() const {
    std::vector<std::size_t> closed;
    for (std::size_t i = 0; i < patches_.size(); ++i)
      if (patches_[i].is_closed) closed.push_back(i);
    std::sort(closed.begin(), closed.end(), [&](std::size_t a, std::size_t b) {
      const double va = std::abs(patches_[a].volume_m3), vb = std::abs(patches_[b].volume_m3);
      return va != vb ? va > vb : a < b;
    });
    return closed;
  }

  /// The facets of the given patches that have area; shells are numbered in the order of the list.
  ShellFacets facetsOf(const std::vector<std::size_t>& closed) {
    ShellFacets facets{{mesh().vertices, {}}, {}};
    for (std::uint32_t shell = 0; shell < closed.size(); ++shell)
      for (const std::uint32_t i : patches_[closed[shell]].triangles) {
        if (!(facetOf(mesh(), i).area_m2 > 0)) continue;
        facets.mesh.triangles.push_back(mesh().triangles[i]);
        facets.shell_of.push_back(shell);
      }
    return facets;
  }

  /// Turns closed patches that face in and lie within no other patch, with everything that lies within them.
  /// Patches that cross each other, and copies of a patch, lie within no patch, so that all of them face out
  /// before coincident facets cancel each other.
  void turnClosed() {
    const std::vector<std::size_t> closed = closedByVolume();
    if (std::none_of(closed.begin(), closed.end(), [&](std::size_t i) { return patches_[i].volume_m3 < 0; }))
      return;
    const double touch_m = touchDistance(mesh());
    std::vector<Box> boxes;
    for (const std::size_t i : closed) boxes.push_back(patches_[i].box);
    const BoxTree tree(boxes);
    std::vector<char> is_turned(closed.size(), 0), is_outermost(closed.size(), 0);
    std::optional<ShellNesting> nesting;
    std::vector<std::uint32_t> around;
    for (std::uint32_t i = 0; i < closed.size(); ++i) {
      pollStop();
      Patch& patch = patches_[closed[i]];
      around.clear();
      tree.forEachOverlap(boxes, patch.box, [&](std::uint32_t k) {
        if (is_outermost[k] && isWithin(patch.box, grown(boxes[k], touch_m))) around.push_back(k);
        return true;
      });
      std::sort(around.begin(), around.end());
      if (!around.empty() && !nesting) {
        ShellFacets facets = facetsOf(closed);
        nesting.emplace(std::move(facets.mesh), std::move(facets.shell_of));
      }
      const auto outer = std::find_if(around.begin(), around.end(),
                                      [&](std::uint32_t k) { return nesting->liesWithin(i, k); });
      is_outermost[i] = outer == around.end();
      is_turned[i] = is_outermost[i] ? patch.volume_m3 < 0 : is_turned[*outer];
      if (is_turned[i]) flip(patch);
    }
  }

  /// Samples of a patch: facets spread evenly over its area.
  [[nodiscard]] std::vector<Facet> samplesOf(const Patch& patch, std::size_t most) {
    double area_m2 = 0;
    for (const std::uint32_t i : patch.triangles) area_m2 += facetOf(mesh(), i).area_m2;
    const std::size_t count = std::min(most, patch.triangles.size());
    std::vector<Facet> samples;
    double sum_m2 = 0;
    for (const std::uint32_t i : patch.triangles) {
      const Facet facet = facetOf(mesh(), i);
      sum_m2 += facet.area_m2;
      const double due = (static_cast<double>(samples.size()) + 0.5) * area_m2 / static_cast<double>(count);
      if (facet.area_m2 > 0 && sum_m2 > due) samples.push_back(facet);
    }
    return samples;
  }

  /// The winding number in the plane of a facet of the mesh: a half more than just in front of the facet.
  static double inPlane(const WindingNumber& w, const Facet& f) {
    return w.at(f.center + 1e-5 * std::sqrt(f.area_m2) * f.normal).w + 0.5;
  }

  /// Mean winding number in the planes of each patch's samples.
  std::vector<double> meanInPlane(const WindingNumber& w) {
    std::vector<double> mean(patches_.size(), 0.5);
    onAllCores(patches_.size(), [&](std::size_t i) {
      const std::vector<Facet> samples = samplesOf(patches_[i], kSamples);
      if (samples.empty()) return;
      double sum = 0;
      for (const Facet& f : samples) {
        pollStop();
        sum += inPlane(w, f);
      }
      mean[i] = sum / static_cast<double>(samples.size());
    });
    return mean;
  }

  void turnOpenByWinding() {
    const std::vector<double> mean = meanInPlane(WindingNumber(mesh()));
    for (std::size_t i = 0; i < patches_.size(); ++i)
      if (!patches_[i].is_closed && mean[i] < 0.5 - kClearly - 0.25) flip(patches_[i]);
  }

  /// Result of the first hit of a ray: 1 (outside) for nothing or a front, -1 (inside) for a back, 0 for the
  /// ray's own patch.
  int sideSeen(const MeshDistance& all, const Facet& from, const Vec3& way, std::uint32_t own,
               double size_m) {
    Vec3 p = from.center + 1e-3 * std::sqrt(from.area_m2) * way;
    for (int step = 0; step < 200; ++step) {
      const MeshDistance::Closest next = all.closest(p);
      if (next.distance_m > size_m) return 1;
      if (next.distance_m < 1e-6 * size_m && step > 0) {
        if (patch_of_[next.triangle] == own) return 0;
        return facetOf(mesh(), next.triangle).normal.dot(way) < 0 ? 1 : -1;
      }
      p += std::max(next.distance_m, 1e-7 * size_m) * way;
    }
    return 0;
  }

  /// Turns patches for which rays show that the front faces the solid and the back faces out.
  void turnOpenByRays() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < patches_.size(); ++i)
      if (!patches_[i].is_closed) open.push_back(i);
    if (patches_.size() < 2 || 2 * open.size() > kMaxRays) return;
    const std::size_t most = std::clamp<std::size_t>(kMaxRays / 2 / open.size(), 1, 16);
    const double size_m = bounds(mesh()).size().norm();
    for (int sweep = 0; sweep < 3; ++sweep) {
      const MeshDistance all(mesh());
      std::vector<char> is_wrong(open.size(), 0);
      onAllCores(open.size(), [&](std::size_t k) {
        const std::vector<Facet> samples = samplesOf(patches_[open[k]], most);
        int votes = 0;
        for (const Facet& f : samples) {
          pollStop();
          const auto own = static_cast<std::uint32_t>(open[k]);
          votes += sideSeen(all, f, f.normal, own, size_m) - sideSeen(all, f, -f.normal, own, size_m);
        }
        is_wrong[k] = votes < -static_cast<int>(samples.size());  // each sample has two rays
      });
      for (std::size_t k = 0; k < open.size(); ++k)
        if (is_wrong[k]) flip(patches_[open[k]]);
      if (std::find(is_wrong.begin(), is_wrong.end(), 1) == is_wrong.end()) return;
    }
  }

  /// Sets aside nearly flat patches with solid on both sides or on neither. Such a patch does not bound a
  /// solid, but would raise the winding number on one side and lower it on the other by a half.
  void setAsideWallsAndSheets() {
    const std::vector<double> mean = meanInPlane(WindingNumber(mesh()));
    std::vector<std::size_t> aside;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      pollStop();
      if (patches_[i].is_closed || std::abs(mean[i] - 0.5) < kClearly) continue;
      const WindingNumber alone(mesh(), patches_[i].triangles);
      double self = 0;
      const std::vector<Facet> samples = samplesOf(patches_[i], kSamples);
      for (const Facet& f : samples) self += inPlane(alone, f) / static_cast<double>(samples.size());
      if (std::abs(self) > 0.5 - kClearly) continue;
      aside.push_back(i);
      setKept(patches_[i], mean[i] > 0.5 ? Keep::None : Keep::Surface);
    }
    if (aside.size() > 1 && aside.size() <= kMaxCopies) keepOneOfCopies(aside);
    for (const std::size_t i : aside) {
      const Keep keep = is_kept_[patches_[i].triangles[0]];
      if (keep == Keep::None) report().internal_facets += patches_[i].triangles.size();
      if (keep == Keep::Surface) report().sheet_facets += patches_[i].triangles.size();
    }
  }

  void setKept(const Patch& patch, Keep keep) {
    for (const std::uint32_t t : patch.triangles) is_kept_[t] = keep;
  }

  /// Keeps one of several copies of a patch of the surface that are cut into different facets. Together the
  /// copies look like sheets, since the winding number falls by two across them; the first copy alone does
  /// not look like a sheet.
  void keepOneOfCopies(const std::vector<std::size_t>& aside) {
    std::vector<std::uint32_t> bounding;
    for (std::uint32_t i = 0; i < is_kept_.size(); ++i)
      if (is_kept_[i] == Keep::Both) bounding.push_back(i);
    for (const std::size_t i : aside) {
      pollStop();
      const std::vector<std::uint32_t>& own = patches_[i].triangles;
      bounding.insert(bounding.end(), own.begin(), own.end());
      const WindingNumber w(mesh(), bounding);
      double mean = 0;
      const std::vector<Facet> samples = samplesOf(patches_[i], kSamples);
      for (const Facet& f : samples) mean += inPlane(w, f) / static_cast<double>(samples.size());
      if (std::abs(mean - 0.5) < kClearly)
        setKept(patches_[i], Keep::Both);
      else
        bounding.resize(bounding.size() - own.size());
    }
  }

  void dropInternalFacets() {
    std::vector<std::uint32_t> bounding;
    for (std::uint32_t i = 0; i < is_kept_.size(); ++i)
      if (is_kept_[i] == Keep::Both) bounding.push_back(i);
    const WindingNumber w(mesh(), bounding);
    // Test every facet only if shells' boxes overlap or a sample of a patch lies within the solid.
    if (!mayOverlap(w)) return;
    const double size_m = bounds(mesh()).size().norm();
    onAllCores(bounding.size(), [&](std::size_t k) {
      if (isWithinSolidOrVoid(w, bounding[k], size_m)) is_kept_[bounding[k]] = Keep::Solid;
    });
    std::vector<char> is_overlapping(patches_.size(), 0);
    for (const std::uint32_t i : bounding) {
      if (is_kept_[i] != Keep::Solid) continue;
      ++report().internal_facets;
      is_overlapping[patch_of_[i]] = 1;
    }
    report().overlapping_shells =
        static_cast<std::size_t>(std::count(is_overlapping.begin(), is_overlapping.end(), 1));
  }

  bool mayOverlap(const WindingNumber& w) {
    if (is_crossing_) return true;
    const std::vector<Box> boxes = boxesOfClosed();
    if (haveOverlap(boxes)) return true;
    for (const Patch& patch : patches_)
      for (const Facet& f : samplesOf(patch, kSamples)) {
        pollStop();
        if (inPlane(w, f) > kInternal) return true;
      }
    return false;
  }

  /// True if both sides of a facet are solid or, for a facet of a closed shell, neither is: a void within a
  /// void. The facet is tested at its middle, near its corners and, if it is large enough to pass through
  /// several shells, on a grid: corners and middle of a floor can be in the walls of a box whose inside is
  /// free.
  bool isWithinSolidOrVoid(const WindingNumber& w, std::uint32_t triangle, double size_m) {
    Facet f = facetOf(mesh(), triangle);
    if (!(f.area_m2 > 0)) return false;
    const bool is_closed = patches_[patch_of_[triangle]].is_closed;
    const auto isSurface = [&] {
      const double value = inPlane(w, f);
      return value < kInternal && (value > kExternal || !is_closed);
    };
    if (isSurface()) return false;
    const Vec3 middle = f.center;
    for (const std::uint32_t v : mesh().triangles[triangle]) {
      f.center = middle + 0.9 * (mesh().vertices[v] - middle);
      if (isSurface()) return false;
    }
    constexpr double kLarge = 0.05;  // share of the mesh's size for each division of a side
    constexpr int kMostDivisions = 24;
    const auto& [a, b, c] = mesh().triangles[triangle];
    const Vec3 u = 0.95 * (mesh().vertices[b] - mesh().vertices[a]),
               v = 0.95 * (mesh().vertices[c] - mesh().vertices[a]),
               corner = middle + 0.95 * (mesh().vertices[a] - middle);
    const double side_m = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int n = std::min(kMostDivisions, static_cast<int>(side_m / (kLarge * size_m)));
    for (int i = 0; i <= n && n > 0; ++i)
      for (int k = 0; k <= n - i; ++k) {
        pollStop();
        f.center = corner + static_cast<double>(i) / n * u + static_cast<double>(k) / n * v;
        if (isSurface()) return false;
      }
    return true;
  }

  RepairedMesh finish(bool is_sound) {
    result_.is_sound = is_sound;
    if (is_kept_.empty()) {
      result_.surface = mesh();
      return std::move(result_);
    }
    result_.surface.vertices = mesh().vertices;
    std::vector<std::array<std::uint32_t, 3>> solid;
    for (std::size_t i = 0; i < mesh().triangles.size(); ++i) {
      const Keep keep = is_kept_[i];
      if (keep == Keep::Both || keep == Keep::Solid) solid.push_back(mesh().triangles[i]);
      if (keep == Keep::Both || keep == Keep::Surface)
        result_.surface.triangles.push_back(mesh().triangles[i]);
    }
    if (result_.surface.triangles.empty()) result_.surface.triangles = mesh().triangles;
    mesh().triangles = std::move(solid);
    return std::move(result_);
  }

  const bool is_crossing_, is_single_;
  bool has_cancelled_ = false;     // of some back-to-back duplicates no facet was kept
  bool is_contact_known_ = false;  // all closed shells were tested, and none touch
  std::size_t united_facets_ = 0;  // the number of first facets that come from an earlier union
  RepairedMesh result_;
  std::vector<HalfEdge> edges_;  // with the facets' original directions
  JoinedFacets joined_;          // with the facets' original directions
  std::vector<Patch> patches_;
  std::vector<std::uint32_t> patch_of_;   // by triangle
  std::vector<std::uint8_t> is_flipped_;  // by triangle: turned since edges_ were found
  std::vector<Keep> is_kept_;             // by triangle
};

}  // namespace

RepairedMesh repairMesh(Mesh mesh, Crossing crossing) {
  return Repairer(std::move(mesh), crossing).run();
}

RepairedMesh repairCrossing(const RepairedMesh& sound) {
  RepairedMesh again = repairMesh(sound.surface, Crossing::Seen);
  again.is_sound = false;
  again.report.triangles = sound.report.triangles;
  again.report.duplicate_triangles += sound.report.duplicate_triangles;
  again.report.flipped_edges += sound.report.flipped_edges;
  again.report.flipped_facets += sound.report.flipped_facets;
  again.report.turned_shells += sound.report.turned_shells;
  again.report.joined_corners += sound.report.joined_corners;
  again.report.joined_m = std::max(again.report.joined_m, sound.report.joined_m);
  return again;
}

std::string describe(const MeshReport& report) {
  std::string text;
  const auto say = [&](std::size_t count, const char* one, const char* many) {
    if (count == 0) return;
    if (!text.empty()) text += ", ";
    text += std::to_string(count) + " " + (count == 1 ? one : many);
  };
  say(report.shells, "shell", "shells");
  say(report.open_edges, "open edge", "open edges");
  say(report.holes, "hole or crack", "holes or cracks");
  say(report.t_junctions, "T-junction", "T-junctions");
  say(report.non_manifold_edges, "edge with more than two facets", "edges with more than two facets");
  say(report.duplicate_triangles, "duplicate facet left out", "duplicate facets left out");
  say(report.degenerate_triangles, "facet without area", "facets without area");
  say(report.flipped_facets, "flipped facet turned", "flipped facets turned");
  say(report.turned_shells, "inward-facing shell turned", "inward-facing shells turned");
  say(report.united_shells, "touching or overlapping shell united", "touching or overlapping shells united");
  if (report.united_shells == 0) say(report.overlapping_shells, "overlapping shell", "overlapping shells");
  say(report.internal_facets, "facet within the solid left out", "facets within the solid left out");
  say(report.sheet_facets, "facet of a sheet without an inside", "facets of sheets without an inside");
  if (report.is_union_incomplete)
    text += std::string(text.empty() ? "" : ", ") +
            "shells that touch or overlap could not be united, so that depths near these shells are those of "
            "single shells and the mass counts the common volume of two shells twice";
  if (report.joined_corners > 0) {
    char joined[96];
    std::snprintf(joined, sizeof joined, "%s%zu %s joined across cracks of up to %.2g um",
                  text.empty() ? "" : ", ", report.joined_corners,
                  report.joined_corners == 1 ? "corner" : "corners", 1e6 * report.joined_m);
    text += joined;
  }
  char certain[80];
  // Rounded down, so that 100 % means all nodes.
  std::snprintf(certain, sizeof certain, "; the sign of the distance is certain at %.4g %% of the nodes",
                std::floor(1e4 * report.certain_share) / 1e2);
  return text + certain;
}

}  // namespace vps
