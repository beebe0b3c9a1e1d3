// SPDX-License-Identifier: BSD-3-Clause
#include "web/snapshot_coder.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "vps_device/detail/bytes.h"

namespace vps::viewer {

namespace {

using device::ByteWriter;

constexpr std::uint8_t kHasTarget = 1, kHasHand = 2, kIsWhole = 4;
constexpr std::uint8_t kGone = 255;

void putVector(ByteWriter& writer, const Vec3& x) {
  for (const double component : x) writer.put(static_cast<float>(component));
}

std::uint8_t signedByte(double share) {
  return static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lround(127 * std::clamp(share, -1.0, 1.0))));
}

}  // namespace

std::string SnapshotCoder::poseBytes(const Pose& X_W) const {
  std::string bytes;
  ByteWriter writer(bytes);
  putVector(writer, X_W.p - center_W_);
  const Eigen::Quaterniond q(X_W.R);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) writer.put(static_cast<float>(value));
  return bytes;
}

void SnapshotCoder::putBodies(const std::vector<scenes::BodySnapshot>& bodies, std::string& out) {
  std::string changed;
  ByteWriter writer(changed);
  std::uint16_t count = 0;
  std::set<std::uint16_t> there;
  for (const scenes::BodySnapshot& body : bodies) {
    const auto part = static_cast<std::uint16_t>(body.part);
    if (!there.insert(part).second) continue;
    std::string state(1, static_cast<char>(body.role));
    state += poseBytes(body.X_WP);
    std::string& sent = sent_[part];
    if (sent == state) continue;
    writer.put(part);
    writer.bytes(state);
    sent = std::move(state);
    ++count;
  }
  for (auto entry = sent_.begin(); entry != sent_.end();) {
    if (there.contains(entry->first)) {
      ++entry;
      continue;
    }
    writer.put(entry->first);
    writer.put(kGone);
    writer.bytes(poseBytes({}));
    ++count;
    entry = sent_.erase(entry);
  }
  ByteWriter(out).put(count);
  out += changed;
}

std::string SnapshotCoder::encode(const WatchedShot& shot) {
  const scenes::Snapshot& s = shot.snapshot;
  std::string out;
  ByteWriter writer(out);
  const bool is_whole = number_ == 0;
  writer.put(kShotKind);
  writer.put(++number_);
  writer.put(s.time_s);
  writer.put(1e-6 * static_cast<double>(shot.taken_ns));
  writer.put(static_cast<std::uint16_t>(static_cast<std::int16_t>(s.step)));
  writer.put(static_cast<std::uint8_t>((s.has_target ? kHasTarget : 0) | (s.has_hand ? kHasHand : 0) |
                                       (is_whole ? kIsWhole : 0)));
  putBodies(s.bodies, out);
  if (s.has_target) {
    writer.put(static_cast<std::uint16_t>(s.target_part));
    writer.bytes(poseBytes(s.X_WP_target));
  }
  if (s.has_hand) {
    writer.bytes(poseBytes(s.X_W_Proxy));
    putVector(writer, s.F_hand_W.f);
    putVector(writer, s.F_hand_W.tau);
  }
  const std::size_t contacts = std::min(s.contacts.size(), kMostContacts);
  writer.put(static_cast<std::uint16_t>(contacts));
  for (std::size_t i = 0; i < contacts; ++i) {
    const scenes::ContactMark& mark = s.contacts[i];
    putVector(writer, mark.p_W - center_W_);
    for (const double component : mark.n_W) writer.put(signedByte(component));
    writer.put(static_cast<float>(1e6 * mark.depth_m));
    writer.put(static_cast<float>(mark.force_N));
  }
  return out;
}

std::string blowBytes(const BlowSound& sound) {
  double most_Pa = 1e-9;  // samples are scaled to the range of 16 bits
  for (const double p : sound.pressure_Pa) most_Pa = std::max(most_Pa, std::abs(p));
  std::string bytes;
  ByteWriter writer(bytes);
  writer.put(kBlowKind);
  writer.put(1e-6 * static_cast<double>(sound.taken_ns));
  writer.put(static_cast<std::uint32_t>(BlowSound::kRate_hz));
  writer.put(static_cast<float>(most_Pa));
  for (const double p : sound.pressure_Pa)
    writer.put(static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(32767 * p / most_Pa))));
  return bytes;
}

}  // namespace vps::viewer
