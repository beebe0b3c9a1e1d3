// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "check/check_placed.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

namespace {

using Point = std::array<double, 2>;
using Chain = std::vector<Point>;
using Edge = std::array<std::uint32_t, 2>;

/// The cut of a facet by the plane: it leads from the point where one edge crosses the plane to the point
/// where another edge does, with the material on the left as seen from in front.
struct Cut {
  Edge from, to;
};

class Cutter {
 public:
  Cutter(const PlacedSurface& part, const CheckedSection& section)
      : part_(part),
        section_(section),
        n_W_(section.right_W.cross(section.up_W)),
        n_P_(part.X_WP.R.transpose() * n_W_),
        offset_m_(n_P_.dot(part.X_WP.inverse() * section.at_W)) {}

  [[nodiscard]] std::vector<Cut> cuts() const {
    std::vector<Cut> out;
    const Mesh& mesh = part_.surface->mesh();
    part_.surface->tree().forEach([&](const Box& box) { return meets(box); },
                                  [&](std::uint32_t i) { appendCut(mesh.triangles[i], out); });
    return out;
  }

  [[nodiscard]] Point crossing(const Edge& edge) const {
    const Mesh& mesh = part_.surface->mesh();
    const Vec3 &a = mesh.vertices[edge[0]], &b = mesh.vertices[edge[1]];
    const double at_a = above(a), at_b = above(b);
    const Vec3 r = part_.X_WP * (a + at_a / (at_a - at_b) * (b - a)) - section_.at_W;
    return {section_.right_W.dot(r), section_.up_W.dot(r)};
  }

 private:
  [[nodiscard]] double above(const Vec3& p_P) const { return n_P_.dot(p_P) - offset_m_; }

  [[nodiscard]] bool meets(const Box& box) const {
    const double reach_m = 0.5 * n_P_.cwiseAbs().dot(box.size());
    return std::abs(above(box.center())) <= 1.0000001 * reach_m + 1e-12;
  }

  void appendCut(const std::array<std::uint32_t, 3>& t, std::vector<Cut>& out) const {
    std::array<bool, 3> is_front{};
    for (std::size_t k = 0; k < 3; ++k) is_front[k] = above(part_.surface->mesh().vertices[t[k]]) >= 0;
    Cut cut;
    int crossings = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (is_front[k] == is_front[(k + 1) % 3]) continue;
      const auto [low, high] = std::minmax(a, b);
      (is_front[k] ? cut.from : cut.to) = {low, high};
      ++crossings;
    }
    if (crossings == 2) out.push_back(cut);
  }

  const PlacedSurface& part_;
  const CheckedSection& section_;
  Vec3 n_W_, n_P_;
  double offset_m_;
};

double squaredDistance(const Point& a, const Point& b) {
  return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
}

/// Joins the end of each open chain to the nearest beginning of a chain. Returns true if an end and the
/// beginning joined to it were more than same_m apart.
bool closeChains(std::vector<Chain>& open, std::vector<Chain>& closed, double same_m) {
  bool has_gap = false;
  while (!open.empty()) {
    Chain chain = std::move(open.back());
    open.pop_back();
    for (;;) {
      double least_m2 = squaredDistance(chain.back(), chain.front());
      std::size_t next = open.size();
      for (std::size_t i = 0; i < open.size(); ++i)
        if (const double m2 = squaredDistance(chain.back(), open[i].front()); m2 < least_m2) {
          least_m2 = m2;
          next = i;
        }
      has_gap = has_gap || least_m2 > same_m * same_m;
      if (next == open.size()) break;
      chain.insert(chain.end(), open[next].begin(), open[next].end());
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(next));
    }
    if (chain.size() > 2) closed.push_back(std::move(chain));
  }
  return has_gap;
}

}  // namespace

SectionOutline outlineOf(const PlacedSurface& part, const CheckedSection& section) {
  const Cutter cutter(part, section);
  const std::vector<Cut> cuts = cutter.cuts();
  std::multimap<Edge, std::size_t> beginning;
  for (std::size_t i = 0; i < cuts.size(); ++i) beginning.emplace(cuts[i].from, i);
  // A chain that is open at its beginning starts at a cut whose beginning is the end of no other cut.
  std::map<Edge, int> ends;
  for (const Cut& cut : cuts) ++ends[cut.to];
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < cuts.size(); ++i)
    if (!ends.contains(cuts[i].from)) starts.push_back(i);
  for (std::size_t i = 0; i < cuts.size(); ++i) starts.push_back(i);

  std::vector<bool> is_used(cuts.size());
  std::vector<Chain> open, closed;
  for (const std::size_t start : starts) {
    if (is_used[start]) continue;
    Chain chain{cutter.crossing(cuts[start].from)};
    std::size_t now = start;
    bool is_closed = false;
    for (;;) {
      is_used[now] = true;
      is_closed = cuts[now].to == cuts[start].from;
      if (is_closed) break;
      chain.push_back(cutter.crossing(cuts[now].to));
      const auto [first, end] = beginning.equal_range(cuts[now].to);
      const auto next = std::find_if(first, end, [&](const auto& entry) { return !is_used[entry.second]; });
      if (next == end) break;
      now = next->second;
    }
    (is_closed ? closed : open).push_back(std::move(chain));
  }
  SectionOutline out{part.name, {}, false};
  out.is_open = closeChains(open, closed, 1e-6 * part.surface->box().size().norm());
  for (const Chain& chain : closed)
    if (Chain kept = clippedToSquare(chain, {}, 1.1 * section.half_m); kept.size() > 2)
      out.chains.push_back(std::move(kept));
  return out;
}

}  // namespace vps::scenes
