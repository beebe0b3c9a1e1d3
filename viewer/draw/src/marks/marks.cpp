// SPDX-License-Identifier: BSD-3-Clause
#include "marks/marks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "mesh/shading_mesh.h"

namespace vps::viewer {
namespace {

Mark makeMark(const Vec3& base_C, const Vec3& axis_C, double length_m, double width_m,
              const Eigen::Vector3f& color) {
  return {toFloat(base_C),
          toFloat(axis_C),
          {static_cast<float>(length_m), static_cast<float>(width_m)},
          {color.x(), color.y(), color.z()}};
}

}  // namespace

Eigen::Vector3f depthColor(double share) {
  static const std::array<Eigen::Vector3f, 4> kStops = {
      Eigen::Vector3f(1.00f, 0.76f, 0.05f), Eigen::Vector3f(1.00f, 0.30f, 0.01f),
      Eigen::Vector3f(0.75f, 0.02f, 0.02f), Eigen::Vector3f(0.22f, 0.00f, 0.02f)};
  const double t = 3 * std::clamp(share, 0.0, 1.0);
  const int i = std::min(2, static_cast<int>(t));
  const auto f = static_cast<float>(t - i);
  return (1 - f) * kStops[i] + f * kStops[i + 1];
}

MarkList listMarks(const scenes::Snapshot& snapshot, const Pose& X_CW, double size_m,
                   const DrawOptions& options) {
  MarkList marks;
  if (options.show_contacts) {
    // Only the deepest contacts get arrows, because more than a few dozen arrows hide each other and the
    // part.
    std::vector<std::size_t> order(snapshot.contacts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return snapshot.contacts[a].depth_m > snapshot.contacts[b].depth_m;
    });
    constexpr std::size_t kMaxArrows = 40, kMaxDiscs = 4000;
    order.resize(std::min(order.size(), kMaxDiscs));
    for (std::size_t i = 0; i < order.size(); ++i) {
      const scenes::ContactMark& c = snapshot.contacts[order[i]];
      const double share = c.depth_m / options.contact_full_scale_m;
      const Eigen::Vector3f color = depthColor(share);
      const Vec3 base_C = X_CW * c.p_W, axis_C = X_CW.R * c.n_W.normalized();
      if (!base_C.allFinite() || !axis_C.allFinite() || axis_C.isZero()) continue;
      marks.discs.push_back(makeMark(base_C, axis_C, 0.0015 * size_m, 0.009 * size_m, color));
      if (i < kMaxArrows) {
        const double length_m = size_m * (0.035 + 0.035 * std::clamp(share, 0.0, 1.0));
        marks.arrows.push_back(makeMark(base_C, axis_C, length_m, 0.012 * size_m, color));
      }
    }
  }
  const Vec3& f = snapshot.F_hand_W.f;
  if (options.show_force && snapshot.has_hand && f.allFinite() &&
      f.norm() > 0.01 * options.force_full_scale_N) {
    const double length_m = 0.16 * size_m * std::min(1.5, f.norm() / options.force_full_scale_N);
    marks.arrows.push_back(makeMark(X_CW * snapshot.X_W_Proxy.p, X_CW.R * f.normalized(),
                                    std::max(length_m, 0.04 * size_m), 0.026 * size_m, kForceColor));
  }
  return marks;
}

MarkShape MarkShape::arrow() {
  return lathe({{0, 0}, {0.16, 0}, {0.16, 0.62}, {0.5, 0.62}, {0, 1}});
}

MarkShape MarkShape::disc() {
  return lathe({{0, -1}, {0.5, -1}, {0.5, 1}, {0, 1}});
}

MarkShape MarkShape::lathe(const std::vector<std::array<double, 2>>& profile) {
  constexpr int kSegments = 20;
  std::vector<Vertex> triangles;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const auto [r0, z0] = profile[k];
    const auto [r1, z1] = profile[k + 1];
    const double length = std::hypot(r1 - r0, z1 - z0);
    const double n_r = (z1 - z0) / length, n_z = (r0 - r1) / length;
    const auto vertex = [n_r = n_r, n_z = n_z](double r, double z, int segment) {
      const double a = 2 * std::numbers::pi * segment / kSegments;
      return Vertex{toFloat({r * std::cos(a), r * std::sin(a), z}),
                    toFloat({n_r * std::cos(a), n_r * std::sin(a), n_z})};
    };
    for (int s = 0; s < kSegments; ++s) {
      const Vertex a = vertex(r0, z0, s), b = vertex(r0, z0, s + 1), c = vertex(r1, z1, s + 1),
                   d = vertex(r1, z1, s);
      triangles.insert(triangles.end(), {a, b, c, a, c, d});
    }
  }
  return MarkShape(triangles);
}

MarkShape::MarkShape(const std::vector<Vertex>& triangles)
    : vertices_(gl::makeBuffer(std::span<const Vertex>(triangles))),
      vertex_count_(static_cast<GLsizei>(triangles.size())) {}

void MarkShape::draw(const std::vector<Mark>& marks) const {
  if (marks.empty()) return;
  const gl::Buffer instances = gl::makeBuffer(std::span<const Mark>(marks));
  const gl::VertexArray array = gl::makeVertexArray();
  gl::addAttribute(array, vertices_, 0, 3, offsetof(Vertex, p), sizeof(Vertex));
  gl::addAttribute(array, vertices_, 1, 3, offsetof(Vertex, n), sizeof(Vertex));
  gl::addAttribute(array, instances, 2, 3, offsetof(Mark, base_C), sizeof(Mark), 1);
  gl::addAttribute(array, instances, 3, 3, offsetof(Mark, axis_C), sizeof(Mark), 1);
  gl::addAttribute(array, instances, 4, 2, offsetof(Mark, size_m), sizeof(Mark), 1);
  gl::addAttribute(array, instances, 5, 3, offsetof(Mark, color), sizeof(Mark), 1);
  glBindVertexArray(array.id());
  glDrawArraysInstanced(GL_TRIANGLES, 0, vertex_count_, static_cast<GLsizei>(marks.size()));
}

}  // namespace vps::viewer
