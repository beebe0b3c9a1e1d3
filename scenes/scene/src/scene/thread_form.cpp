// SPDX-License-Identifier: BSD-3-Clause
#include "scene/thread_form.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace vps::scenes {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Radius of the surface around an axis, by angle and height: the greatest radius for the outside of a solid,
/// or the least for a bore.
class RadiusMap {
 public:
  static constexpr int kAngles = 64;
  static constexpr int kHeights = 512;

  RadiusMap(const Mesh& mesh, const Vec3& p, const Vec3& axis, bool is_inside)
      : is_inside_(is_inside), radius_m_(std::size_t{kAngles} * kHeights, kUnknown) {
    const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
    std::vector<Vec3> at;  // vertices in a frame with z along the axis
    low_m_ = std::numeric_limits<double>::infinity();
    double high_m = -low_m_;
    for (const Vec3& v : mesh.vertices) {
      const Vec3 r = v - p;
      at.emplace_back(r.dot(x), r.dot(y), r.dot(axis));
      low_m_ = std::min(low_m_, at.back().z());
      high_m = std::max(high_m, at.back().z());
    }
    row_m_ = (high_m - low_m_) / kHeights;
    if (!(row_m_ > 0)) return;
    for (const auto& t : mesh.triangles) pollStop(), sample(at[t[0]], at[t[1]], at[t[2]]);
  }

  [[nodiscard]] double row_m() const { return row_m_; }
  [[nodiscard]] double at(int angle, int row) const {
    return radius_m_[static_cast<std::size_t>(angle) * kHeights + static_cast<std::size_t>(row)];
  }

 private:
  // Samples a triangle at points that are closer to each other than half a cell of the map at the triangle's
  // greatest radius.
  void sample(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double radius_m = std::max({a.head<2>().norm(), b.head<2>().norm(), c.head<2>().norm()});
    const double arc_m = std::max(radius_m * kTurn_rad / kAngles, row_m_);
    const auto pieces = [&](const Vec3& way) {
      constexpr double kMost = 4 * kHeights;
      return static_cast<int>(
          std::clamp(std::ceil(2 * (std::abs(way.z()) / row_m_ + way.head<2>().norm() / arc_m)), 1.0, kMost));
    };
    // The samples are on lines parallel to ac; the corners are swapped until ac is the shortest side.
    if (pieces(b - a) < pieces(c - a)) return sample(a, c, b);
    if (pieces(b - c) < pieces(c - a)) return sample(c, a, b);
    const int n = std::max(pieces(b - a), pieces(b - c));
    for (int i = 0; i <= n; ++i) {
      const Vec3 from = a + (b - a) * i / n, to = c + (b - c) * i / n;  // points on ab and on cb
      const int m = pieces(to - from);
      for (int k = 0; k <= m; ++k) put(from + (to - from) * k / m);
    }
  }

  void put(const Vec3& q) {
    const double turn = std::atan2(q.y(), q.x()) / kTurn_rad;
    const int angle = static_cast<int>(std::floor((turn - std::floor(turn)) * kAngles)) % kAngles;
    const int row = std::clamp(static_cast<int>((q.z() - low_m_) / row_m_), 0, kHeights - 1);
    double& radius_m = radius_m_[static_cast<std::size_t>(angle) * kHeights + static_cast<std::size_t>(row)];
    const double here_m = q.head<2>().norm();
    if (std::isnan(radius_m) || (is_inside_ ? here_m < radius_m : here_m > radius_m)) radius_m = here_m;
  }

  bool is_inside_;
  double low_m_ = 0, row_m_ = 0;
  std::vector<double> radius_m_;
};

/// One wave around a helix: r = mean + 2 |c| cos(2 pi z / pitch - order angle + phase).
struct Wave {
  int order = 0;  // positive: right-handed
  double pitch_m = 0;
  double amplitude_m = 0;
  double share = 0;  // share of the variance in the window
};

constexpr int kMostStarts = 4;

/// A row of the map: its mean, its mean square, and the Fourier coefficients around the axis.
struct Row {
  bool is_known = false;
  double mean_m = 0, mean_square_m2 = 0;
  std::complex<double> wave[kMostStarts + 1];  // [m]: order m; order -m has the conjugate
};

Row rowOf(const RadiusMap& map, int row) {
  constexpr double kKnown = 0.8;
  constexpr int kAngles = RadiusMap::kAngles;
  Row out;
  int known = 0;
  for (int i = 0; i < kAngles; ++i)
    if (const double r = map.at(i, row); !std::isnan(r)) {
      out.mean_m += r;
      ++known;
    }
  if (known < kKnown * kAngles) return out;
  out.is_known = true;
  out.mean_m /= known;
  for (int i = 0; i < kAngles; ++i) {
    const double known_m = map.at(i, row), r = std::isnan(known_m) ? out.mean_m : known_m;
    out.mean_square_m2 += r * r / kAngles;
    for (int m = 1; m <= kMostStarts; ++m)
      out.wave[m] += r / kAngles * std::polar(1.0, kTurn_rad * m * (i + 0.5) / kAngles);
  }
  return out;
}

/// The rows of a window (a range of heights of the map), and their spectrum along the axis.
class Spectrum {
 public:
  Spectrum(std::span<const Row> rows, double row_m)
      : rows_(rows), row_m_(row_m), count_(static_cast<int>(rows.size())) {
    double sum = 0, squares = 0;
    for (const Row& row : rows) {
      if (!row.is_known) return;
      sum += row.mean_m / count_;
      squares += row.mean_square_m2 / count_;
    }
    variance_m2_ = squares - sum * sum;
    is_known = variance_m2_ > 0;
  }

  /// The strongest wave with an order other than 0.
  [[nodiscard]] Wave strongest() const {
    constexpr double kLeastRows = 5, kLeastTurns = 2;
    constexpr int kFiner = 4;  // frequency steps between n and n + 1 waves in the window
    const double length_m = count_ * row_m_;
    Wave best;
    double best_power = 0, best_frequency = 0;
    Eigen::FFT<double> transform;
    std::vector<std::complex<double>> spectrum, padded(static_cast<std::size_t>(kFiner * count_));
    for (int m = -kMostStarts; m <= kMostStarts; ++m) {
      if (m == 0) continue;  // order 0: grooves around the axis, not a thread
      for (int row = 0; row < count_; ++row)
        padded[static_cast<std::size_t>(row)] = smooth(row) * waveAt(m, row);
      transform.fwd(spectrum, padded);
      for (int k = static_cast<int>(kLeastTurns * kFiner); k < kFiner * count_ / kLeastRows; ++k)
        if (const double power = std::norm(spectrum[static_cast<std::size_t>(k)]); power > best_power) {
          best_power = power;
          best_frequency = k / (kFiner * length_m);
          best.order = m;
        }
    }
    if (!(best_power > 0)) return best;
    // With a smooth window, the power has a single peak between the neighbouring frequencies, which a ternary
    // search finds.
    double low = best_frequency - 0.5 / length_m, high = best_frequency + 0.5 / length_m;
    for (int i = 0; i < 40; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      if (std::norm(coefficient(best.order, a, true)) < std::norm(coefficient(best.order, b, true)))
        low = a;
      else
        high = b;
    }
    best.pitch_m = 2 / (low + high);
    const double c_m = std::abs(coefficient(best.order, 1 / best.pitch_m, false));
    best.amplitude_m = 2 * c_m;
    best.share = 2 * c_m * c_m / variance_m2_;
    return best;
  }

  bool is_known = false;  ///< the radius is known in all rows of the window, and not constant

 private:
  [[nodiscard]] std::complex<double> waveAt(int order, int row) const {
    const std::complex<double>* wave = rows_[static_cast<std::size_t>(row)].wave;
    return order < 0 ? std::conj(wave[-order]) : wave[order];
  }
  // A raised cosine, so that the ends of the window cause little spectral leakage.
  [[nodiscard]] double smooth(int row) const { return 1 - std::cos(kTurn_rad * (row + 0.5) / count_); }

  // @param is_smooth  weights the rows by smooth()
  [[nodiscard]] std::complex<double> coefficient(int order, double frequency, bool is_smooth) const {
    const std::complex<double> step = std::polar(1.0, -kTurn_rad * frequency * row_m_);
    std::complex<double> turn = 1, sum = 0;
    for (int row = 0; row < count_; ++row, turn *= step) {
      sum += (is_smooth ? smooth(row) : 1) * turn * waveAt(order, row);
    }
    return sum / double(count_);
  }

  std::span<const Row> rows_;
  double row_m_;
  int count_;
  double variance_m2_ = 0;
};

// The thread in the longest window in which the thread has most of the variance.
std::optional<ThreadForm> threadIn(const RadiusMap& map, bool is_inside) {
  constexpr double kMostlyThread = 0.5, kLeastDepth = 0.05;  // assumed; values of ISO threads: 0.9, 0.5
  if (!(map.row_m() > 0)) return std::nullopt;
  std::vector<Row> rows;
  for (int row = 0; row < RadiusMap::kHeights; ++row) rows.push_back(rowOf(map, row));
  std::optional<ThreadForm> best;
  double best_share = kMostlyThread;
  for (int length = RadiusMap::kHeights; length >= RadiusMap::kHeights / 8 && !best; length = length * 2 / 3)
    for (int first = 0; first + length <= RadiusMap::kHeights; first += std::max(1, length / 8)) {
      pollStop();
      const Spectrum spectrum(std::span<const Row>(rows).subspan(static_cast<std::size_t>(first),
                                                                 static_cast<std::size_t>(length)),
                              map.row_m());
      if (!spectrum.is_known) continue;
      const Wave wave = spectrum.strongest();
      if (!(wave.share > best_share) || 2 * wave.amplitude_m < kLeastDepth * wave.pitch_m) continue;
      best_share = wave.share;
      best = ThreadForm{wave.order * wave.pitch_m, std::abs(wave.order), is_inside};
    }
  return best;
}

}  // namespace

std::optional<ThreadForm> findThread(const Mesh& mesh, const Vec3& p, const Vec3& axis) {
  for (const bool is_inside : {false, true})
    if (const auto form = findThread(mesh, p, axis, is_inside)) return form;
  return std::nullopt;
}

std::optional<ThreadForm> findThread(const Mesh& mesh, const Vec3& p, const Vec3& axis, bool is_inside) {
  return threadIn(RadiusMap(mesh, p, axis, is_inside), is_inside);
}

}  // namespace vps::scenes
