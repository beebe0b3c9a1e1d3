// SPDX-License-Identifier: BSD-3-Clause
#include "subject.h"

namespace vps::bench {

namespace {

constexpr Simd kPaths[] = {Simd::Best, Simd::Scalar, Simd::Avx2, Simd::Avx512};

Simd pathOf(const std::string& name) {
  for (const Simd simd : kPaths)
    if (name == toText(simd)) return simd;
  return Simd::Best;
}

}  // namespace

struct Subject::State {
  const VoxMap& map;
  const PointShell& shell;
  SubjectOptions options;
  QueryMemory memory;
};

std::vector<std::string> instructionPaths() {
  std::vector<std::string> names;
  for (const Simd simd : kPaths)
    if (simd == Simd::Best || availableSimd(simd) == simd) names.emplace_back(toText(simd));
  return names;
}

Subject::Subject(const VoxMap& map, const PointShell& shell, const SubjectOptions& options)
    : state_(new State{map, shell, options, QueryMemory(map, shell)}) {}
Subject::~Subject() = default;

Answer Subject::step(const Pose& X_MP) {
  QueryOptions query;
  query.is_exhaustive = state_->options.is_exhaustive;
  query.gradient = Gradient::Trilinear;
  query.simd = pathOf(state_->options.path);
  TouchSummary sum;
  const QueryResult result =
      queryWrench(state_->map, state_->shell, X_MP, query, kStiffness_N_per_m3, Vec3::Zero(), sum,
                  state_->options.is_coherent ? &state_->memory : nullptr);
  return {sum.count, result.min_distance_m, sum.F_O_M};
}

struct Mounting::State {
  VoxMap base, mounted;
};

Mounting::Mounting(const Mesh& base, const Mesh& mounted, const VoxMapSettings& settings)
    : state_(new State{cookVoxMap({{&base, Pose()}}, settings), buildVoxMap(mounted, settings)}) {}
Mounting::~Mounting() = default;

VoxMap Mounting::mount(const Pose& X_BM) const {
  return mountVoxMap(state_->base, PlacedMap{&state_->mounted, X_BM});
}

}  // namespace vps::bench
