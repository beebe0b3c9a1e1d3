// SPDX-License-Identifier: BSD-3-Clause
#include "messages/dense_state.h"

#include <cmath>

namespace vps::scenes {

namespace {

/// Quantisation of a component of a unit quaternion: the integer that represents x is middle + scale * x,
/// rounded.
struct Steps {
  explicit Steps(unsigned bits)
      : mask((std::uint64_t{1} << bits) - 1),
        middle(1 << (bits - 1U)),
        scale((middle - 1) * 1.41421356237309515) {}
  std::uint64_t mask;
  double middle;  ///< integer that represents zero
  double scale;   ///< integers per unit; the greatest value of a smaller component is 1/sqrt(2)
};

}  // namespace

std::uint64_t packedRotation(const Mat3& R, unsigned bits) {
  const Steps steps(bits);
  Eigen::Vector4d q = Eigen::Quaterniond(R).normalized().coeffs();  // x y z w
  Eigen::Index largest = 0;
  q.cwiseAbs().maxCoeff(&largest);
  if (q[largest] < 0) q = -q;
  std::uint64_t packed = static_cast<std::uint64_t>(largest);
  for (Eigen::Index i = 0; i < 4; ++i)
    if (i != largest)
      packed = packed << bits | static_cast<std::uint64_t>(std::lround(steps.middle + steps.scale * q[i]));
  return packed;
}

std::optional<Mat3> unpackedRotation(std::uint64_t packed, unsigned bits) {
  const Steps steps(bits);
  const unsigned all = 3 * bits;
  if (packed >> (all + 2U) != 0) return {};
  const auto largest = static_cast<Eigen::Index>(packed >> all);
  Eigen::Vector4d q = Eigen::Vector4d::Zero();
  double rest = 1;
  unsigned shift = all;
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (i == largest) continue;
    shift -= bits;
    q[i] = (static_cast<double>(packed >> shift & steps.mask) - steps.middle) / steps.scale;
    rest -= q[i] * q[i];
  }
  constexpr double kLeast = 0.249;  // The square of the largest component is at least 1/4, less rounding.
  if (!(rest >= kLeast)) return {};
  q[largest] = std::sqrt(rest);
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

}  // namespace vps::scenes
