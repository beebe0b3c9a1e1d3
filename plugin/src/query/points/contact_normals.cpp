// SPDX-License-Identifier: BSD-3-Clause
#include "query/points/contact_normals.h"

namespace vps {
namespace {

float mix(float a, float b, float t) {
  return a + t * (b - a);
}

/// Fraction of a voxel of a position in steps.
float fractionOf(std::int32_t steps) {
  return static_cast<float>(steps & (kSteps - 1)) / kSteps;
}

/// Derivative of the trilinear distance, in quanta, from the corners that the leaf's read fetched.
void trilinearGradient(const ReadLeaf& leaf, int i, float g[3]) {
  float d[8];
  for (int k = 0; k < 4; ++k) {
    const std::int32_t pair = leaf.batch.pair[k][i];
    d[2 * k] = static_cast<float>(static_cast<std::int16_t>(pair & 0xffff));
    d[2 * k + 1] = static_cast<float>(pair >> 16);
  }
  const float x = fractionOf(leaf.batch.x[i]), y = fractionOf(leaf.batch.y[i]),
              z = fractionOf(leaf.batch.z[i]);
  g[0] = mix(mix(d[4] - d[0], d[5] - d[1], z), mix(d[6] - d[2], d[7] - d[3], z), y);
  g[1] = mix(mix(d[2] - d[0], d[3] - d[1], z), mix(d[6] - d[4], d[7] - d[5], z), x);
  g[2] = mix(mix(d[1] - d[0], d[3] - d[2], y), mix(d[5] - d[4], d[7] - d[6], y), x);
}

}  // namespace

double readingAt(const ReadLeaf& leaf, int lane, const GridPose& motion, const Vec3& p_P) noexcept {
  double value = static_cast<double>(leaf.value(lane));
  if (!leaf.batch.is_read[leaf.slot]) return value;
  const int i = kLanes * leaf.slot + lane;
  float g[3];
  trilinearGradient(leaf, i, g);
  const std::int32_t steps[3] = {leaf.batch.x[i], leaf.batch.y[i], leaf.batch.z[i]};
  for (int k = 0; k < 3; ++k) {
    const double at = motion.p[k] + motion.R[3 * k] * p_P.x() + motion.R[3 * k + 1] * p_P.y() +
                      motion.R[3 * k + 2] * p_P.z();
    value += static_cast<double>(g[k]) * (at - leaf.batch.base[leaf.slot][k] - steps[k] * (1.0 / kSteps));
  }
  return value;
}

void ContactNormals::add(const ReadLeaf& leaf, int lane) noexcept {
  const int i = kLanes * leaf.slot + lane;
  if (gradient_ == Gradient::Trilinear) {
    float g[3] = {0, 0, 0};
    if (leaf.batch.is_read[leaf.slot]) trilinearGradient(leaf, i, g);
    for (int axis = 0; axis < 3; ++axis) n_[axis][count_] = g[axis];
    ++count_;
    return;
  }
  const std::int32_t at[3] = {leaf.batch.x[i], leaf.batch.y[i], leaf.batch.z[i]};
  for (int k = 0; k < kReads; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const int step = k / 2 != axis ? 0 : k % 2 != 0 ? 1 : -1;
      whole_[axis][kReads * count_ + k] = leaf.batch.base[leaf.slot][axis] + (at[axis] >> kStepBits) + step;
      t_[axis][kReads * count_ + k] = fractionOf(at[axis]);
    }
  ++count_;
}

int ContactNormals::compute() noexcept {
  if (gradient_ == Gradient::Continuous && count_ > 0) {
    const std::int32_t* const whole[3] = {whole_[0], whole_[1], whole_[2]};
    const float* const t[3] = {t_[0], t_[1], t_[2]};
    reading_.kernels.readAt(reading_.field, whole, t, kReads * count_, value_);
    for (int i = 0; i < count_; ++i)
      for (int axis = 0; axis < 3; ++axis)
        n_[axis][i] = value_[kReads * i + 2 * axis + 1] - value_[kReads * i + 2 * axis];
  }
  return count_;
}

}  // namespace vps
