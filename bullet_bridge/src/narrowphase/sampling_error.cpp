// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/sampling_error.h"

#include <cmath>

namespace vps::bullet {

Curvature::Curvature(const Mat3& turn_per_m) {
  const double half = 0.5 * turn_per_m.trace();
  const double product = 0.5 * (4 * half * half - turn_per_m.squaredNorm());
  const double apart = std::sqrt(std::max(half * half - product, 0.0));
  most_per_m = half + apart;
  least_per_m = half - apart;
}

namespace {

// Of the face that a candidate's point lies on.
double ownCurvature_per_m(const PairView& pair, const Candidate& c) {
  const Shape* shape = pair.shape[c.side];
  if (c.isCrossing() || !shape || shape->models().surfaces.empty() || shape->isEdgePoint(c.id)) return 0;
  const Shape::PointFace face = shape->faceAt(c.id);
  if (!shape->features().isCurved(face.surface, face.triangle)) return 0;
  const Surface& surface = shape->models().surfaces[face.surface];
  return surface.sheet ? 0 : Curvature(surface.distance->smoothCurvature(face.triangle)).most_per_m;
}

}  // namespace

SamplingError::SamplingError(const PairView& pair, std::span<const Candidate> near) : pair_(pair) {
  for (const Candidate& c : near)
    most_per_m_[c.side] = std::max(most_per_m_[c.side], ownCurvature_per_m(pair, c));
}

double SamplingError::of_m(const Candidate& c) const {
  const Shape* shape = pair_.shape[c.side];
  if (c.isCrossing() || !shape || shape->isEdgePoint(c.id)) return 0;
  return samplingError_m(shape->models().shell->spacing_m,
                         std::max(ownCurvature_per_m(pair_, c), 0.0) + most_per_m_[1 - c.side]);
}

}  // namespace vps::bullet
