// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/union/shell_union.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "mesh/mesh_edges.h"
#include "mesh/triangle_distance.h"
#include "mesh/union/facet_arrangement.h"
#include "mesh/union/shell_pieces.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/stoppable.h"
#include "vps/winding_number.h"

namespace vps {
namespace {

constexpr std::int64_t kAnglesInStep = 16;  ///< number of solid angles of triangles in a step of work

/// Solid angle over 4 pi. Source: van Oosterom and Strackee 1983.
double solidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double up = a.dot(b.cross(c)), across = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return std::atan2(up, across) / (2 * std::numbers::pi);
}

/// Tells on which sides of points of the shells' surfaces the solid is.
class Shells {
 public:
  /// The facets of other shells that are flush with a facet at a point.
  struct Flush {
    int same = 0, opposite = 0;  ///< shells with a flush facet that faces the same way, or the opposite way
    bool is_first = true;        ///< no shell before the facet's own has a facet that faces the same way
  };

  Shells(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of, double touch_m)
      : mesh_(mesh),
        shell_of_(shell_of),
        touch_m_(touch_m),
        boxes_(boxesOf(mesh, shell_of, touch_m)),
        facet_boxes_(triangleBoxes(mesh)),
        tree_(boxes_),
        facets_(facet_boxes_),
        winding_(mesh, kClusterError) {
    triangles_.resize(boxes_.size());
    for (std::uint32_t i = 0; i < shell_of.size(); ++i) triangles_[shell_of[i]].push_back(i);
  }

  /// True if a piece of facet f at p, with f's own orientation, belongs to the surface of the union. If
  /// several flush facets have that orientation, only the facet of the first shell is kept. Returns nothing
  /// if only isKeptBySum() can tell.
  [[nodiscard]] std::optional<bool> isKeptBySeries(std::uint32_t f, const Vec3& p) const {
    const Vec3 up = kBeside * touch_m_ * normal(f);
    if (hasFacetBeside(f, p)) return std::nullopt;
    // A flush facet adds a half behind it and subtracts a half in front of it: the mean does not depend on
    // it.
    const WindingNumber::Value front = winding_.at(p + up), back = winding_.at(p - up);
    constexpr double kMostError = 0.2;  // of a margin of 0.5
    if (0.5 * (front.error + back.error) > kMostError) return std::nullopt;
    return isKept(flushAt(f, p), 0.5 * (front.w + back.w));
  }
  /// As isKeptBySeries(), by the sum over the triangles of all shells around p.
  [[nodiscard]] bool isKeptBySum(std::uint32_t f, const Vec3& p) const {
    double w = 0;
    StridedPoll poll;
    for (const std::uint32_t shell : around(p))
      for (const std::uint32_t i : triangles_[shell]) {
        poll();
        if (i != f && !isFlush(i, p)) w += solidAngleOf(i, p);
      }
    return isKept(flushAt(f, p), w);
  }
  /// The number of triangles in the sum of isKeptBySum().
  [[nodiscard]] std::int64_t sizeOfSum(const Vec3& p) const {
    std::int64_t size = 0;
    for (const std::uint32_t shell : around(p)) size += static_cast<std::int64_t>(triangles_[shell].size());
    return size;
  }

  [[nodiscard]] std::size_t count() const { return boxes_.size(); }

  [[nodiscard]] bool isInside(const Vec3& p) const {
    double w = 0;
    StridedPoll poll;
    for (const std::uint32_t shell : around(p))
      for (const std::uint32_t i : triangles_[shell]) {
        poll();
        w += solidAngleOf(i, p);
      }
    return w > 0.5;
  }
  /// True if p is so near to a facet that rounding decides on which side it is.
  [[nodiscard]] bool isOnSurface(const Vec3& p) const {
    const double near_m = kBeside * touch_m_;
    return !forEachNear(p, near_m, [&](std::uint32_t i) { return distance(i, p) > near_m; });
  }

 private:
  static constexpr double kClusterError = 1e-4;
  /// Distance from a facet at which the winding number is evaluated, in touch_m_. Flush facets are at most 2
  /// touch_m_ away.
  static constexpr double kBeside = 8;

  static bool isKept(const Flush& flush, double w) {
    const double step = 0.5 * (flush.same - flush.opposite);
    return w - step < 0.5 && w + step > 0.5 && flush.is_first;
  }

  /// The shells whose boxes contain p, in ascending order.
  [[nodiscard]] std::vector<std::uint32_t> around(const Vec3& p) const {
    std::vector<std::uint32_t> shells;
    tree_.forEachOverlap(boxes_, {p, p}, [&](std::uint32_t shell) {
      shells.push_back(shell);
      return true;
    });
    std::sort(shells.begin(), shells.end());
    return shells;
  }
  /// Calls visit for facets that may be nearer to p than distance_m, until visit returns false.
  template <typename Visit>
  bool forEachNear(const Vec3& p, double distance_m, Visit visit) const {
    return facets_.forEachOverlap(facet_boxes_, {p.array() - distance_m, p.array() + distance_m}, visit);
  }
  [[nodiscard]] Flush flushAt(std::uint32_t f, const Vec3& p) const {
    std::vector<std::uint32_t> same = {shell_of_[f]}, opposite;
    const Vec3 n = normal(f);
    forEachNear(p, 2 * touch_m_, [&](std::uint32_t i) {
      // A facet of the same shell is a neighbour, beyond p's nearest side.
      if (shell_of_[i] != shell_of_[f] && isWithin(p, boxes_[shell_of_[i]]) && isFlush(i, p))
        (normal(i).dot(n) > 0 ? same : opposite).push_back(shell_of_[i]);
      return true;
    });
    const auto countOf = [](std::vector<std::uint32_t>& shells) {
      std::sort(shells.begin(), shells.end());
      return static_cast<int>(std::unique(shells.begin(), shells.end()) - shells.begin());
    };
    Flush flush;
    flush.same = countOf(same), flush.opposite = countOf(opposite);
    flush.is_first = same.front() == shell_of_[f];
    return flush;
  }
  /// True if a facet that is not flush may lie between p and the point where the winding number is evaluated:
  /// a neighbour, or a facet of a shell at a distance of a few times touch_m_.
  [[nodiscard]] bool hasFacetBeside(std::uint32_t f, const Vec3& p) const {
    const double near_m = 2 * kBeside * touch_m_;
    return !forEachNear(p, near_m, [&](std::uint32_t i) {
      const double away_m = distance(i, p);
      return i == f || away_m > near_m || (away_m <= 2 * touch_m_ && shell_of_[i] != shell_of_[f]);
    });
  }

  [[nodiscard]] const Vec3& corner(std::uint32_t i, std::size_t k) const {
    return mesh_.vertices[mesh_.triangles[i][k]];
  }
  [[nodiscard]] Vec3 normal(std::uint32_t i) const {
    return (corner(i, 1) - corner(i, 0)).cross(corner(i, 2) - corner(i, 0)).normalized();
  }
  [[nodiscard]] double solidAngleOf(std::uint32_t i, const Vec3& p) const {
    return solidAngle(corner(i, 0) - p, corner(i, 1) - p, corner(i, 2) - p);
  }
  [[nodiscard]] double distance(std::uint32_t i, const Vec3& p) const {
    return (closestOnTriangle(p, corner(i, 0), corner(i, 1), corner(i, 2)).q - p).norm();
  }
  [[nodiscard]] bool isFlush(std::uint32_t i, const Vec3& p) const {
    return isWithin(p, boxOf(mesh_, i, 2 * touch_m_)) && distance(i, p) <= 2 * touch_m_;
  }

  const Mesh& mesh_;
  const std::vector<std::uint32_t>& shell_of_;
  const double touch_m_;
  const std::vector<Box> boxes_, facet_boxes_;  // of shells, and of facets
  const BoxTree tree_, facets_;
  const WindingNumber winding_;
  std::vector<std::vector<std::uint32_t>> triangles_;
};

bool isClosed(const Mesh& mesh) {
  bool is_closed = !mesh.triangles.empty();
  forEachEdge(sortedHalfEdges(mesh),
              [&](std::span<const HalfEdge> same) { is_closed = is_closed && surplusOf(same) == 0; });
  return is_closed;
}

/// The radical inverse of i: evenly spread in 0 to 1 [Halton 1960].
double halton(int i, int base) {
  double value = 0, digit = 1;
  for (; i > 0; i /= base) value += (digit /= base) * (i % base);
  return value;
}

/// True if the mesh and the shells have the same inside, tested at points spread over the box. Points on a
/// surface prove nothing and are skipped; faces in planes of round coordinates contain some of the points.
bool agree(const Mesh& mesh, const Shells& shells) {
  constexpr int kPoints = 64;
  const std::vector<std::uint32_t> all(mesh.triangles.size(), 0);
  const Shells united(mesh, all, 0);
  const Box box = bounds(mesh);
  std::array<char, kPoints> agrees{};
  onAllCores(kPoints, [&](std::size_t k) {
    const int i = static_cast<int>(k);
    const Vec3 share(halton(i + 1, 2), halton(i + 1, 3), halton(i + 1, 5));
    const Vec3 p = box.min + share.cwiseProduct(box.size());
    agrees[k] = shells.isOnSurface(p) || united.isInside(p) == shells.isInside(p);
  });
  return std::find(agrees.begin(), agrees.end(), 0) == agrees.end();
}

/// The mesh without vertices that no triangle uses.
Mesh compacted(const Mesh& mesh) {
  Mesh out;
  std::vector<std::uint32_t> number(mesh.vertices.size(), UINT32_MAX);
  for (auto t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      if (number[v] == UINT32_MAX) {
        number[v] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    out.triangles.push_back(t);
  }
  return out;
}

/// Counts shells with facets that were cut, or with edges in common with other shells.
std::size_t countMet(const Arrangement& cut, const std::vector<std::uint32_t>& shell_of) {
  std::vector<std::uint32_t> met;
  for (std::size_t i = 1; i < cut.source.size(); ++i)
    if (cut.source[i] == cut.source[i - 1]) met.push_back(shell_of[cut.source[i]]);
  forEachEdge(sortedHalfEdges(cut.mesh), [&](std::span<const HalfEdge> same) {
    if (same.size() <= 2) return;
    for (const HalfEdge& e : same) met.push_back(shell_of[cut.source[e.triangle]]);
  });
  std::sort(met.begin(), met.end());
  return static_cast<std::size_t>(std::unique(met.begin(), met.end()) - met.begin());
}

}  // namespace

double touchDistance(const Mesh& mesh) {
  const Box box = bounds(mesh);
  return kTouchShare * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
}

namespace {

/// Which patches bound the union, each decided at its widest piece; nothing if that takes too much work.
std::optional<std::vector<char>> keptPatches(const Arrangement& cut, const std::vector<std::uint32_t>& widest,
                                             const Shells& shells, std::int64_t& work_left) {
  constexpr char kOpen = 2;
  std::vector<char> is_kept(widest.size());
  onAllCores(widest.size(), [&](std::size_t patch) {
    const auto kept = shells.isKeptBySeries(cut.source[widest[patch]], middleOf(cut.mesh, widest[patch]));
    is_kept[patch] = kept ? static_cast<char>(*kept) : kOpen;
  });
  for (std::size_t patch = 0; patch < widest.size(); ++patch)
    if (is_kept[patch] == kOpen)
      work_left -= 1 + shells.sizeOfSum(middleOf(cut.mesh, widest[patch])) / kAnglesInStep;
  if (work_left < 0) return std::nullopt;
  onAllCores(widest.size(), [&](std::size_t patch) {
    if (is_kept[patch] == kOpen)
      is_kept[patch] = shells.isKeptBySum(cut.source[widest[patch]], middleOf(cut.mesh, widest[patch]));
  });
  return is_kept;
}

/// The pieces that bound the union; empty if that takes too much work. Counts the pieces that are left out.
Mesh surfaceOf(const Arrangement& cut, const std::vector<std::uint32_t>& shell_of, const Shells& shells,
               ShellUnion& out, std::int64_t& work_left) {
  const auto [patch_of, widest] = patchesOf(cut.mesh);
  const auto found = keptPatches(cut, widest, shells, work_left);
  if (!found) return {};
  const std::vector<char>& is_kept = *found;
  Mesh kept = {cut.mesh.vertices, {}};
  std::vector<char> has_piece(shell_of.size(), 0), loses(shells.count(), 0);
  for (std::uint32_t i = 0; i < patch_of.size(); ++i) {
    if (is_kept[patch_of[i]] == 0) {
      loses[shell_of[cut.source[i]]] = 1;
      continue;
    }
    kept.triangles.push_back(cut.mesh.triangles[i]);
    has_piece[cut.source[i]] = 1;
  }
  out.covered_shells = static_cast<std::size_t>(std::count(loses.begin(), loses.end(), 1));
  out.covered_facets = static_cast<std::size_t>(std::count(has_piece.begin(), has_piece.end(), 0));
  return kept;
}

ShellUnion uniteWithin(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of, double touch_m,
                       std::int64_t& work_left) {
  ShellUnion out;
  const std::vector<FacetPair> pairs = nearPairs(mesh, shell_of, touch_m);
  if (pairs.empty()) return out;
  out.united_shells = 2;  // at least two, if the rest of the union fails
  if (pairs.size() > kMostPairs) work_left = -1;
  if (work_left < 0) return out;
  const std::optional<Arrangement> cut = arrange(mesh, pairs, touch_m, work_left);
  if (!cut) return out;
  out.united_shells = countMet(*cut, shell_of);
  if (out.united_shells == 0) return out;
  const Shells shells(mesh, shell_of, touch_m);
  const Mesh surface = surfaceOf(*cut, shell_of, shells, out, work_left);
  if (isClosed(surface) && agree(surface, shells)) out.mesh = compacted(surface);
  return out;
}

}  // namespace

ShellUnion unite(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of) {
  // Vertices about touch_m apart may be merged at one place and not at the next; the union may then succeed
  // with another distance. Overlaps of a micrometre are more than eight times touch_m in parts of up to half
  // a metre.
  constexpr double kOtherShares[] = {8, 1.0 / 32, 1.0 / 1024};
  const double touch_m = touchDistance(mesh);
  std::int64_t work_left = kMostUnionWork;
  ShellUnion first = uniteWithin(mesh, shell_of, touch_m, work_left);
  if (first.united_shells == 0 || !first.mesh.triangles.empty()) return first;
  for (const double share : kOtherShares) {
    if (work_left < 0) break;
    ShellUnion other = uniteWithin(mesh, shell_of, share * touch_m, work_left);
    if (!other.mesh.triangles.empty()) return other;
  }
  return first;
}

bool haveContact(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of) {
  const double touch_m = touchDistance(mesh);
  const std::vector<FacetPair> pairs = nearPairs(mesh, shell_of, touch_m);
  if (pairs.empty()) return false;
  std::int64_t work_left = pairs.size() > kMostPairs ? -1 : kMostUnionWork;
  if (work_left < 0) return true;
  const std::optional<Arrangement> cut = arrange(mesh, pairs, touch_m, work_left);
  return !cut || countMet(*cut, shell_of) > 0;
}

}  // namespace vps
