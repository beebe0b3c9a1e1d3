// SPDX-License-Identifier: BSD-3-Clause
#include "messages/dense_state.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "messages/messages.h"

namespace vps::scenes {

namespace {

constexpr unsigned kSenderBits = 18, kNumberBits = 24, kTickBits = 8, kTimeBits = 32, kLengthBits = 22,
                   kComponentBits = 18;
constexpr double kStep_m = 1e-6, kStep_s = 1e-6;
constexpr double kLargest_m = kStep_m * ((1 << (kLengthBits - 1U)) - 1);
constexpr double kLargest_J = 1e12;  // the limit of all numbers that nodes send
/// Greatest increase of time, or of steps, between consecutive dense states, so that the lower bits identify
/// the full value.
constexpr double kMostLater_s = 1000;
constexpr std::int32_t kMostTicks = 32;
constexpr int kExponents = 32, kLeastExponent = -22;

enum class DenseKind : std::uint8_t { Haptic, Physics };

/// Writes bits, starting with the highest bit of the first byte.
class BitWriter {
 public:
  void put(std::uint64_t value, unsigned bits) noexcept {
    for (unsigned i = bits; i-- > 0; ++at_)
      bytes_[at_ / 8] = static_cast<char>(static_cast<unsigned char>(bytes_[at_ / 8]) << 1U |
                                          static_cast<unsigned char>(value >> i & 1U));
  }
  void putSigned(std::int64_t value, unsigned bits) noexcept {
    put(static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << bits) - 1), bits);
  }
  [[nodiscard]] std::string_view bytes() const noexcept { return {bytes_.data(), bytes_.size()}; }

 private:
  std::array<char, kDenseBytes> bytes_{};
  unsigned at_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::string_view bytes) noexcept : bytes_(bytes) {}
  std::uint64_t get(unsigned bits) noexcept {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < bits; ++i, ++at_)
      value = value << 1U | (static_cast<unsigned char>(bytes_[at_ / 8]) >> (7 - at_ % 8) & 1U);
    return value;
  }
  std::int64_t getSigned(unsigned bits) noexcept {
    const auto value = static_cast<std::int64_t>(get(bits));
    return value < std::int64_t{1} << (bits - 1U) ? value : value - (std::int64_t{1} << bits);
  }

 private:
  std::string_view bytes_;
  unsigned at_ = 0;
};

std::int64_t timeSteps(double time_s) noexcept {
  return std::llround(time_s / kStep_s);
}
/// The number that is nearest to `to` among those with the given lower bits.
std::int64_t nearest(std::uint64_t low, unsigned bits, std::int64_t to) noexcept {
  const std::int64_t all = std::int64_t{1} << bits;
  std::int64_t ahead = (static_cast<std::int64_t>(low) - to) % all;
  if (ahead < -all / 2) ahead += all;
  if (ahead >= all / 2) ahead -= all;
  return to + ahead;
}

bool fits(const Pose& X) noexcept {
  return X.isFinite() && X.p.cwiseAbs().maxCoeff() < kLargest_m;
}
void put(BitWriter& w, const Pose& X) noexcept {
  for (const double x : X.p) w.putSigned(std::llround(x / kStep_m), kLengthBits);
  w.put(packedRotation(X.R, kComponentBits), 3 * kComponentBits + 2);
}
bool get(BitReader& r, Pose& X) noexcept {
  for (double& x : X.p) x = kStep_m * static_cast<double>(r.getSigned(kLengthBits));
  const std::optional<Mat3> R = unpackedRotation(r.get(3 * kComponentBits + 2), kComponentBits);
  if (R) X.R = *R;
  return R.has_value();
}

/// The least exponent for which the largest of the three components fits; kExponents: none fits.
int exponentOf(const Vec3& x, unsigned mantissa) noexcept {
  const double most = (1 << (mantissa - 1U)) - 1, greatest = x.cwiseAbs().maxCoeff();
  int e = 0;
  while (e < kExponents && !(greatest <= most * std::ldexp(1.0, kLeastExponent + e))) ++e;
  return e;
}
void put(BitWriter& w, const Vec3& x, unsigned mantissa) noexcept {
  const int e = exponentOf(x, mantissa);
  w.put(static_cast<std::uint64_t>(e), 5);
  for (const double component : x)
    w.putSigned(std::llround(std::ldexp(component, -kLeastExponent - e)), mantissa);
}
Vec3 getVector(BitReader& r, unsigned mantissa) noexcept {
  const int e = static_cast<int>(r.get(5));
  Vec3 x;
  for (double& component : x)
    component = std::ldexp(static_cast<double>(r.getSigned(mantissa)), kLeastExponent + e);
  return x;
}

constexpr unsigned kTwistMantissa = 9, kForceMantissa = 8;
bool fits(const Vec3& x, unsigned mantissa) noexcept {
  return x.allFinite() && exponentOf(x, mantissa) < kExponents;
}
bool fits(const Twist& V) noexcept {
  return fits(V.w, kTwistMantissa) && fits(V.v, kTwistMantissa);
}
void put(BitWriter& w, const Twist& V) noexcept {
  put(w, V.w, kTwistMantissa);
  put(w, V.v, kTwistMantissa);
}
void get(BitReader& r, Twist& V) noexcept {
  V.w = getVector(r, kTwistMantissa);
  V.v = getVector(r, kTwistMantissa);
}

void putHead(BitWriter& w, DenseKind kind, std::uint64_t sender, std::uint64_t number,
             std::int32_t tick) noexcept {
  w.put(1, 1);
  w.put(static_cast<std::uint64_t>(kind), 2);
  w.put(kMessageVersion % 32U, 5);
  w.put(sender % kDenseSenders, kSenderBits);
  w.put(number, kNumberBits);
  w.put(static_cast<std::uint32_t>(tick), kTickBits);
}
constexpr unsigned kHeadBits = 8 + kSenderBits + kNumberBits;
/// The tick with these lower bits that follows `last`, since ticks increase, or that is slightly before
/// `last`.
std::int32_t tickAfter(std::uint64_t low, std::int32_t last) noexcept {
  constexpr std::int64_t kBefore = 8;
  const std::int64_t middle = last + (std::int64_t{1} << (kTickBits - 1U)) - kBefore;
  return static_cast<std::int32_t>(nearest(low, kTickBits, middle));
}

/// Twist of the part in hand, which moves rigidly with the grasp.
Twist heldTwist(const CouplingState& grasp, const Pose& X_WP) noexcept {
  return {grasp.V_W.w, grasp.V_W.v + grasp.V_W.w.cross(X_WP.p - grasp.X_W.p)};
}
/// Under load, physics time runs slower than the loop's time, and the grasp's twist is given in the loop's
/// time. The pace is the ratio of the part's twist to the twist that follows from the grasp, in steps of
/// 1/64.
constexpr unsigned kPaceBits = 10;
constexpr double kPaceSteps = 64;
double paceOf(const Twist& held, const Twist& follows) noexcept {
  constexpr double kMost = (1U << kPaceBits) - 1;
  const double square = follows.v.squaredNorm() + follows.w.squaredNorm();
  constexpr double kAtRest = 1e-6;
  if (!(square > kAtRest)) return kPaceSteps;
  const double share = (held.v.dot(follows.v) + held.w.dot(follows.w)) / square;
  return std::clamp(std::round(kPaceSteps * share), 1.0, kMost);
}
Twist scaled(const Twist& V, double share) noexcept {
  return {share * V.w, share * V.v};
}

/// Whether a state is older than the newest one. A state whose tick is much lower does not count as older,
/// since one of the two ticks was damaged.
bool isLate(std::int32_t tick, std::int32_t now) noexcept {
  constexpr std::int32_t kFarthest = 64;
  return tick < now && tick >= now - kFarthest;
}
bool isNear(const Pose& a, const Pose& b) noexcept {
  constexpr double kWay_m = 2e-6, kTurn = 1e-5;  // of the order of a dense pose's rounding
  return (a.p - b.p).norm() <= kWay_m && (a.R - b.R).cwiseAbs().maxCoeff() <= kTurn;
}
bool isNear(const Twist& a, const Twist& b) noexcept {
  constexpr double kShare = 4e-3,
                   kLeast = 1e-4;  // relative error of the mantissas; absolute error for a part at rest
  return (a.v - b.v).norm() <= kLeast + kShare * b.v.norm() &&
         (a.w - b.w).norm() <= kLeast + kShare * b.w.norm();
}

}  // namespace

/// Decides whether a whole state is due, and counts the states. @param is_news  a change that all readers
/// need at once
bool DenseWriter::isDue(bool is_news, bool is_wished) noexcept {
  if (is_news) whole_left_ = kWholeAfterNews;
  const bool is_due =
      whole_left_ > 0 || since_whole_ >= kWholeEvery || (is_wished && since_whole_ >= kAtLeast);
  if (!is_due) {
    ++since_whole_;
    return false;
  }
  if (whole_left_ > 0) --whole_left_;
  since_whole_ = 0;
  return true;
}

bool DenseWriter::write(const HapticMessage& m, std::uint64_t sender, std::uint64_t number,
                        std::string& out) noexcept {
  const device::HapticState& state = m.state;
  const device::TickReport& report = state.report;
  const bool is_force = number % 2 == 0;
  const Vec3& shown = is_force ? report.F_hand_W.f : report.F_hand_W.tau;
  const bool is_in_range = fits(report.X_WG) && fits(report.V_WG) && fits(shown, kForceMantissa) &&
                           std::abs(report.time_s - time_s_) < kMostLater_s && state.tick >= tick_ &&
                           state.tick - tick_ < kMostTicks;
  time_s_ = report.time_s;
  tick_ = state.tick;
  const bool is_news = state.safety.fault != safety_.fault || state.safety.faults != safety_.faults;
  if (isDue(is_news, report.clutch_ratio != clutch_ratio_) || !is_in_range) {
    safety_ = state.safety;
    clutch_ratio_ = report.clutch_ratio;
    since_whole_ = 0;
    return false;
  }
  BitWriter w;
  putHead(w, DenseKind::Haptic, sender, number, state.tick);
  w.put(static_cast<std::uint64_t>(report.status), 3);
  w.put(static_cast<std::uint64_t>(state.safety.fault), 3);
  w.put(static_cast<std::uint64_t>(state.proxy.is_coupled), 1);
  w.put(m.hand, 8);
  w.putSigned(timeSteps(report.time_s), kTimeBits);
  put(w, report.X_WG);
  put(w, report.V_WG);
  put(w, shown, kForceMantissa);
  out.assign(w.bytes());
  return true;
}

bool DenseWriter::write(const PhysicsMessage& m, std::uint64_t sender, std::uint64_t number,
                        std::string& out) noexcept {
  const device::PhysicsState& state = m.state;
  const bool is_in_range = fits(state.part.X_W) && fits(state.part.V_W) &&
                           std::abs(state.part.time_s - time_s_) < kMostLater_s && state.step >= tick_ &&
                           state.step - tick_ < kMostTicks && std::isfinite(state.stored_J.value_or(0));
  time_s_ = state.part.time_s;
  tick_ = state.step;
  const Pose X_WP = state.part.X_W * X_GP_;
  const Twist follows = heldTwist(state.part, X_WP);
  const double pace = paceOf(state.held.V_WP, follows);
  const bool is_news =
      state.held.weight_W != held_.weight_W || (state.part.is_coupled && !isNear(X_WP, state.held.X_WP));
  const bool is_wished = state.part.is_coupled ? !isNear(scaled(follows, pace / kPaceSteps), state.held.V_WP)
                                               : !isNear(state.held.X_WP, held_.X_WP);
  if (isDue(is_news, is_wished) || !is_in_range) {
    held_ = state.held;
    X_GP_ = state.part.X_W.inverse() * state.held.X_WP;
    since_whole_ = 0;
    return false;
  }
  BitWriter w;
  putHead(w, DenseKind::Physics, sender, number, state.step);
  w.put(static_cast<std::uint64_t>(state.part.is_coupled), 1);
  w.put(static_cast<std::uint64_t>(state.stored_J.has_value()), 1);
  w.put(std::bit_cast<std::uint32_t>(static_cast<float>(state.stored_J.value_or(0))), 32);
  w.putSigned(timeSteps(state.part.time_s), kTimeBits);
  put(w, state.part.X_W);
  put(w, state.part.V_W);
  w.put(static_cast<std::uint64_t>(pace), kPaceBits);
  out.assign(w.bytes());
  return true;
}

DenseHead denseHead(std::string_view bytes, std::uint64_t last_number) noexcept {
  BitReader r(bytes);
  r.get(8);
  const auto sender = static_cast<std::uint32_t>(r.get(kSenderBits));
  const std::uint64_t low = r.get(kNumberBits);
  if (last_number == 0) return {sender, low};
  const std::int64_t number = nearest(low, kNumberBits, static_cast<std::int64_t>(last_number));
  return {sender, static_cast<std::uint64_t>(std::max<std::int64_t>(0, number))};
}

namespace {
bool isKind(std::string_view bytes, DenseKind kind) noexcept {
  return (static_cast<unsigned char>(bytes[0]) >> 5U & 3U) == static_cast<unsigned>(kind);
}
}  // namespace

bool isDenseOf(std::string_view bytes, const HapticMessage&) noexcept {
  return isKind(bytes, DenseKind::Haptic);
}
bool isDenseOf(std::string_view bytes, const PhysicsMessage&) noexcept {
  return isKind(bytes, DenseKind::Physics);
}
bool isThisVersion(std::string_view bytes) noexcept {
  return (static_cast<unsigned char>(bytes[0]) & 31U) == kMessageVersion % 32U;
}

bool readDense(std::string_view bytes, const DenseBase&, HapticMessage& m) noexcept {
  BitReader r(bytes);
  r.get(8 + kSenderBits);
  const std::uint64_t number = r.get(kNumberBits);
  device::HapticState& state = m.state;
  device::TickReport& report = state.report;
  state.tick = tickAfter(r.get(kTickBits), state.tick);
  const std::uint64_t status = r.get(3), fault = r.get(3);
  constexpr std::uint64_t kStatuses = 6;
  if (status >= kStatuses) return false;
  report.status = static_cast<Status>(status);
  state.safety.fault = static_cast<device::SafetyFault>(fault);
  state.proxy.is_coupled = r.get(1) == 1;
  m.hand = static_cast<std::uint8_t>(r.get(8));
  report.time_s =
      kStep_s * static_cast<double>(nearest(r.get(kTimeBits), kTimeBits, timeSteps(report.time_s)));
  if (!get(r, report.X_WG)) return false;
  get(r, report.V_WG);
  (number % 2 == 0 ? report.F_hand_W.f : report.F_hand_W.tau) = getVector(r, kForceMantissa);
  return true;
}

bool readDense(std::string_view bytes, const DenseBase& base, PhysicsMessage& m) noexcept {
  BitReader r(bytes);
  r.get(kHeadBits);
  device::PhysicsState& state = m.state;
  state.step = tickAfter(r.get(kTickBits), state.step);
  state.part.is_coupled = r.get(1) == 1;
  const bool has_stored = r.get(1) == 1;
  const auto stored_J = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(r.get(32))));
  if (!(std::abs(stored_J) <= kLargest_J) || (!has_stored && stored_J != 0)) return false;
  state.stored_J = has_stored ? std::optional(stored_J) : std::nullopt;
  state.part.time_s =
      kStep_s * static_cast<double>(nearest(r.get(kTimeBits), kTimeBits, timeSteps(state.part.time_s)));
  if (!get(r, state.part.X_W)) return false;
  get(r, state.part.V_W);
  const auto pace = static_cast<double>(r.get(kPaceBits));
  if (pace == 0) return false;
  if (!state.part.is_coupled) return true;  // the part stays where it was
  state.held.X_WP = state.part.X_W * base.X_GP;
  state.held.V_WP = scaled(heldTwist(state.part, state.held.X_WP), pace / kPaceSteps);
  return true;
}

void keepNewer(HapticMessage& read, const HapticMessage& now) noexcept {
  if (!isLate(read.state.tick, now.state.tick)) return;
  const device::TickReport slow = read.state.report;
  read.hand = now.hand;
  read.state.tick = now.state.tick;
  read.state.proxy = now.state.proxy;
  read.state.report = now.state.report;
  read.state.report.F_hand_D = slow.F_hand_D;
  read.state.report.clutch_ratio = slow.clutch_ratio;
  read.state.safety.fault = now.state.safety.fault;
}
void keepNewer(PhysicsMessage& read, const PhysicsMessage& now) noexcept {
  if (!isLate(read.state.step, now.state.step)) return;
  const Pose X_GP = baseOf(read).X_GP;
  read.state.part = now.state.part;
  read.state.step = now.state.step;
  read.state.stored_J = now.state.stored_J;
  if (!now.state.part.is_coupled) return;
  read.state.held.X_WP = now.state.part.X_W * X_GP;
  read.state.held.V_WP = heldTwist(now.state.part, read.state.held.X_WP);
}

bool isOlder(const HapticMessage& read, const HapticMessage& now) noexcept {
  return read.state.tick < now.state.tick;
}
bool isOlder(const PhysicsMessage& read, const PhysicsMessage& now) noexcept {
  return read.state.step < now.state.step;
}

DenseBase baseOf(const HapticMessage&) noexcept {
  return {true, {}};
}
DenseBase baseOf(const PhysicsMessage& m) noexcept {
  return {true, m.state.part.X_W.inverse() * m.state.held.X_WP};
}

}  // namespace vps::scenes
