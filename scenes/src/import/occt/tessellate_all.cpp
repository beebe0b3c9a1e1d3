// SPDX-License-Identifier: BSD-3-Clause
#include "import/occt/tessellate_all.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <string>

#include <TopExp_Explorer.hxx>

#include "import/forked_workers.h"
#include "import/occt/congruent.h"

namespace vps::scenes::inline v0::import {

namespace {

/// Numbers of a tessellation, which a copy of this process sends as they lie in memory.
struct Figures {
  std::size_t vertices = 0, triangles = 0, faces = 0, open_edges = 0;
  double deviation_m = 0, deflection_m = 0;
  int missing = 0, off = 0, folded = 0, uncovered = 0, outside = 0;
};

struct FaceFigures {
  std::size_t triangles = 0;
  bool is_good = true;
};

template <class T>
void append(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

std::string bytesOf(const Tessellation& t) {
  const Figures figures{t.mesh.vertices.size(),
                        t.mesh.triangles.size(),
                        t.faces.size(),
                        t.open_edges,
                        t.deviation_m,
                        t.deflection_m,
                        t.missing,
                        t.off,
                        t.folded,
                        t.uncovered,
                        t.outside};
  std::string bytes;
  append(bytes, &figures, 1);
  append(bytes, t.mesh.vertices.data(), t.mesh.vertices.size());
  append(bytes, t.mesh.triangles.data(), t.mesh.triangles.size());
  for (const Tessellation::Face& face : t.faces) {
    const FaceFigures own{face.triangles, face.is_good};
    append(bytes, &own, 1);
  }
  return bytes;
}

Tessellation tessellationFrom(const std::string& bytes) {
  const char* at = bytes.data();
  const auto take = [&](auto* values, std::size_t count) {
    if (count > 0) std::memcpy(static_cast<void*>(values), at, count * sizeof *values);
    at += count * sizeof *values;
  };
  Figures figures;
  take(&figures, 1);
  Tessellation t;
  t.mesh.vertices.resize(figures.vertices);
  take(t.mesh.vertices.data(), figures.vertices);
  t.mesh.triangles.resize(figures.triangles);
  take(t.mesh.triangles.data(), figures.triangles);
  for (std::size_t i = 0; i < figures.faces; ++i) {
    FaceFigures own;
    take(&own, 1);
    Tessellation::Face& face = t.faces.emplace_back();
    face.triangles = own.triangles;
    face.is_good = own.is_good;
  }
  t.open_edges = figures.open_edges;
  t.deviation_m = figures.deviation_m;
  t.deflection_m = figures.deflection_m;
  t.missing = figures.missing;
  t.off = figures.off;
  t.folded = figures.folded;
  t.uncovered = figures.uncovered;
  t.outside = figures.outside;
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

}  // namespace vps::scenes::inline v0::import
