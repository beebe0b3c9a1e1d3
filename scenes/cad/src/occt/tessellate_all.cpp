// SPDX-License-Identifier: BSD-3-Clause
#include "occt/tessellate_all.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include <TopExp_Explorer.hxx>

#include "import/forked_workers.h"
#include "import/part_bytes.h"
#include "occt/congruent.h"

namespace vps::scenes::import {

namespace {

/// Without the handles of its faces.
template <class Io>
void transfer(Io& io, Tessellation& t) {
  transfer(io, t.mesh);
  transferEach(io, t.faces, [&](Tessellation::Face& face) {
    transfer(io, face.triangles);
    transfer(io, face.is_good);
  });
  transfer(io, t.deviation_m);
  transfer(io, t.deflection_m);
  for (int* count : {&t.missing, &t.off, &t.folded, &t.uncovered, &t.outside}) transfer(io, *count);
  transfer(io, t.open_edges);
}

std::string bytesOf(Tessellation t) {
  ToBytes io;
  transfer(io, t);
  return std::move(io.out);
}

Tessellation tessellationFrom(const std::string& bytes) {
  FromBytes io(bytes);
  Tessellation t;
  transfer(io, t);
  return t;
}

/// Finds for each shape the first one that it is a rigid copy of.
class Different {
 public:
  explicit Different(double tolerance) : tolerance_(tolerance) {}

  TessellatedShape findOrAdd(const TopoDS_Shape& shape) {
    ShapeTrace trace = traceOf(shape);
    std::vector<std::size_t>& alike = with_kinds_[trace.kinds];
    for (const std::size_t i : alike)
      if (const auto X = motionBetween(traces_[i], trace, tolerance_)) return {i, *X};
    alike.push_back(traces_.size());
    traces_.push_back(std::move(trace));
    shapes_.push_back(shape);
    return {shapes_.size() - 1, Eigen::Affine3d::Identity()};
  }
  [[nodiscard]] const std::vector<TopoDS_Shape>& shapes() const { return shapes_; }

 private:
  double tolerance_;
  std::vector<TopoDS_Shape> shapes_;
  std::vector<ShapeTrace> traces_;
  std::map<std::vector<int>, std::vector<std::size_t>> with_kinds_;
};

/// Those with many edges first, since they take longest.
std::vector<std::size_t> longestFirst(const std::vector<TopoDS_Shape>& shapes) {
  std::vector<int> edges;
  for (const TopoDS_Shape& shape : shapes) {
    edges.push_back(0);
    for (TopExp_Explorer it(shape, TopAbs_EDGE); it.More(); it.Next()) ++edges.back();
  }
  std::vector<std::size_t> order(shapes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return edges[a] > edges[b]; });
  return order;
}

}  // namespace

TessellatedShapes tessellateAll(const std::vector<TopoDS_Shape>& shapes, const ImportSettings& settings,
                                double units_per_m,
                                const std::function<void(std::size_t, std::size_t)>& done) {
  constexpr double kSame_m = 1e-9;
  Different different(kSame_m * units_per_m);
  TessellatedShapes out;
  for (const TopoDS_Shape& shape : shapes) out.shapes.push_back(different.findOrAdd(shape));
  const std::vector<TopoDS_Shape>& own = different.shapes();
  std::size_t count = 0;
  const auto oneMore = [&] {
    if (done) done(++count, own.size());
  };
  const auto make = [&](std::size_t i) { return tessellate(own[i], settings, units_per_m); };
  if (!settings.in_own_process) {  // triangulation then uses threads itself
    for (std::size_t i = 0; i < own.size(); ++i) {
      out.tessellations.push_back(make(i));
      oneMore();
    }
    return out;
  }
  const auto makeBytes = [&](std::size_t i) { return bytesOf(make(i)); };
  for (const std::string& bytes : madeInCopies(longestFirst(own), makeBytes, oneMore))
    out.tessellations.push_back(tessellationFrom(bytes));
  return out;
}

}  // namespace vps::scenes::import
