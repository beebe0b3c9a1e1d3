// SPDX-License-Identifier: BSD-3-Clause
#include "network/packed_rotation.h"

#include <cmath>

namespace vps::scenes::inline v0 {

namespace {

constexpr unsigned kBits = 20;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
constexpr double kMiddle = 1 << (kBits - 1U);                   // of zero, so that no rotation is exact
constexpr double kScale = (kMiddle - 1) * 1.41421356237309515;  // the smaller ones are at most 1/sqrt(2)

}  // namespace

std::uint64_t packedRotation(const Mat3& R) {
  Eigen::Vector4d q = Eigen::Quaterniond(R).normalized().coeffs();  // x y z w
  Eigen::Index largest = 0;
  q.cwiseAbs().maxCoeff(&largest);
  if (q[largest] < 0) q = -q;
  std::uint64_t packed = static_cast<std::uint64_t>(largest);
  for (Eigen::Index i = 0; i < 4; ++i)
    if (i != largest)
      packed = packed << kBits | static_cast<std::uint64_t>(std::lround(kMiddle + kScale * q[i]));
  return packed;
}

std::optional<Mat3> unpackedRotation(std::uint64_t packed) {
  constexpr unsigned kAll = 3 * kBits;
  if (packed >> (kAll + 2U) != 0) return {};
  const auto largest = static_cast<Eigen::Index>(packed >> kAll);
  Eigen::Vector4d q = Eigen::Vector4d::Zero();
  double rest = 1;
  unsigned shift = kAll;
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (i == largest) continue;
    shift -= kBits;
    q[i] = (static_cast<double>(packed >> shift & kMask) - kMiddle) / kScale;
    rest -= q[i] * q[i];
  }
  constexpr double kLeast = 0.249;  // the largest of four is at least 1/2
  if (!(rest >= kLeast)) return {};
  q[largest] = std::sqrt(rest);
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

}  // namespace vps::scenes::inline v0
