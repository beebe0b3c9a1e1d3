// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/local_contact.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "vps/friction.h"

namespace vps::device {
namespace {

constexpr int kRounds = 6;           // greatest number of active-set iterations; two or three suffice
constexpr double kCreep_m_s = 1e-3;  // above this speed friction has its full value. assumed: 10 um in 10 ms

using Vec6 = Eigen::Matrix<double, 6, 1>;  // angular, then linear
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// The linear system A V = b for the velocity after the step.
struct StepSystem {
  Mat6 A = Mat6::Zero();
  Vec6 b = Vec6::Zero();
};

// Stiffness for this step: a spring at its limit is replaced by a softer spring with the same force.
double softened(double k, double stretch, double limit) {
  return k * stretch > limit ? limit / stretch : k;
}

void addCoupling(const CouplingGains& gains, const CouplingState& proxy, const CouplingState& part,
                 double dt_s, StepSystem& system) {
  const Vec3 r_error_W = rotationVector(proxy.X_W.R * part.X_W.R.transpose());
  const Vec3 p_error_W = proxy.X_W.p - part.X_W.p;
  const double k_turn = softened(gains.k_Nm_per_rad, r_error_W.norm(), gains.max_torque_Nm);
  const double k_line = softened(gains.k_N_per_m, p_error_W.norm(), gains.max_force_N);
  system.A.diagonal().head<3>().array() += dt_s * gains.b_Nms_per_rad + dt_s * dt_s * k_turn;
  system.A.diagonal().tail<3>().array() += dt_s * gains.b_Ns_per_m + dt_s * dt_s * k_line;
  system.b.head<3>() += dt_s * (k_turn * r_error_W + gains.b_Nms_per_rad * proxy.V_W.w);
  system.b.tail<3>() += dt_s * (k_line * p_error_W + gains.b_Ns_per_m * proxy.V_W.v);
}

// Adds the normal force k A (-(gap + dt n.v)) where it is positive, and friction of at most mu times that
// force against sliding. Returns the number of touching contacts.
std::size_t addContacts(const LocalPart& part, const ContactSet& near, std::size_t stride, const Vec3& p_WG,
                        double dt_s, const Vec6& V, StepSystem& system) {
  std::size_t touching = 0;
  for (std::size_t i = 0; i < near.contacts.size(); i += stride) {
    const Contact& contact = near.contacts[i];
    const Vec3 n_W = part.X_WM.R * contact.n_M;
    const Vec3 r_W = part.X_WM * contact.p_M - p_WG;
    const LocalPart::Material& material = part.materialAt(contact);
    const double k_N_per_m = material.k_N_per_m3 * contact.area_m2 * static_cast<double>(stride);
    Vec6 J;
    J << r_W.cross(n_W), n_W;
    const double gap_m = contact.distance_m + dt_s * J.dot(V);
    if (gap_m >= 0) continue;
    ++touching;
    system.A.noalias() += (dt_s * dt_s * k_N_per_m) * J * J.transpose();
    system.b -= (dt_s * k_N_per_m * contact.distance_m) * J;
    if (material.friction <= 0) continue;
    Eigen::Matrix<double, 3, 6> slide;
    slide << -crossMatrix(r_W), Mat3::Identity();
    slide -= n_W * (n_W.transpose() * slide);
    const double limit_Ns = dt_s * material.friction * k_N_per_m * -gap_m;
    system.A.noalias() +=
        frictionDamping(limit_Ns, (slide * V).norm(), kCreep_m_s) * slide.transpose() * slide;
  }
  return touching;
}

}  // namespace

LocalContact::LocalContact(const LocalContactSettings& settings)
    : settings_(settings), near_(settings.contact_limit) {}

void LocalContact::take(const LocalPart& part) {
  part_ = part;
  memory_.emplace(*part.map, *part.shell);
  has_snapshot_ = false;
}

CouplingState LocalContact::follow(const CouplingGains& gains, const CouplingState& proxy,
                                   const CouplingState& snapshot, double dt_s) noexcept {
  if (!part_ || !snapshot.is_coupled || !snapshot.X_W.isFinite() || !snapshot.V_W.isFinite()) {
    has_snapshot_ = false;
    return snapshot;
  }
  if (!has_snapshot_ || snapshot.time_s < snapshot_time_s_ || snapshot.time_s > snapshot_time_s_)
    startFrom(gains, proxy, snapshot);
  age_s_ += dt_s;
  if (age_s_ <= settings_.hold_limit_s && step(gains, proxy, dt_s)) return now_;
  ++report_.held;
  now_.V_W = {};
  return now_;
}

void LocalContact::startFrom(const CouplingGains& gains, const CouplingState& proxy,
                             const CouplingState& snapshot) noexcept {
  if (has_snapshot_) {
    report_.jump_J +=
        std::max(0.0, couplingEnergy_J(gains, proxy, snapshot) - couplingEnergy_J(gains, proxy, now_));
    report_.greatest_jump_m = std::max(report_.greatest_jump_m, (snapshot.X_W.p - now_.X_W.p).norm());
  }
  now_ = snapshot;
  snapshot_time_s_ = snapshot.time_s;
  age_s_ = 0;
  has_snapshot_ = true;
}

bool LocalContact::step(const CouplingGains& gains, const CouplingState& proxy, double dt_s) noexcept {
  const LocalPart& part = *part_;
  const Pose X_MP = part.X_WM.inverse() * (now_.X_W * part.X_PG.inverse());
  QueryOptions options;
  options.cutoff_m = std::min(settings_.margin_m, part.map->band_m());
  const QueryResult found = queryContacts(*part.map, *part.shell, X_MP, options, near_, &*memory_);
  if (found.status == Status::Truncated || found.status == Status::BadPose) return false;

  const Mat3& R_WG = now_.X_W.R;
  Vec6 V;
  V << now_.V_W.w, now_.V_W.v;
  StepSystem free;
  free.A.topLeftCorner<3, 3>() = R_WG * part.inertia_G * R_WG.transpose();
  free.A.bottomRightCorner<3, 3>() = part.mass_kg * Mat3::Identity();
  free.b = free.A * V;
  free.b.tail<3>() += dt_s * part.mass_kg * part.gravity_W;
  addCoupling(gains, proxy, now_, dt_s, free);

  // The set of touching contacts and the step depend on each other: iterate from the last velocity.
  const std::size_t stride = 1 + near_.contacts.size() / std::max<std::size_t>(1, settings_.solve_limit);
  std::size_t touching = 0;
  for (int round = 0; round < kRounds; ++round) {
    StepSystem system = free;
    const std::size_t before = touching;
    touching = addContacts(part, near_, stride, now_.X_W.p, dt_s, V, system);
    const Vec6 V_next = system.A.ldlt().solve(system.b);
    if (!V_next.allFinite()) return false;
    const bool is_settled =
        (V_next - V).cwiseAbs().maxCoeff() < 1e-9 || (near_.contacts.empty() && round > 0);
    V = V_next;
    if (is_settled && touching == before) break;
  }
  report_.contacts = touching;
  now_.V_W = {V.head<3>(), V.tail<3>()};
  now_.X_W.p += dt_s * now_.V_W.v;
  now_.X_W.R = rotationFromVector(dt_s * now_.V_W.w) * now_.X_W.R;
  return true;
}

}  // namespace vps::device
