// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/operator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "operator/person.h"

namespace vps::device {

const char* toText(OperatorPhase phase) noexcept {
  switch (phase) {
    case OperatorPhase::Idle:
      return "idle";
    case OperatorPhase::Reach:
      return "reach";
    case OperatorPhase::Insert:
      return "insert";
    case OperatorPhase::Press:
      return "press";
    case OperatorPhase::Done:
      return "done";
    case OperatorPhase::Failed:
      return "failed";
    case OperatorPhase::Regrasp:
      return "index_point";
  }
  return "unknown";
}

const char* toText(OperatorStrategy strategy) noexcept {
#define VPS_NAME(Name, name) , name
  static constexpr std::array kNames = {"none" VPS_OPERATOR_STRATEGIES(VPS_NAME)};
#undef VPS_NAME
  const auto row = static_cast<std::size_t>(strategy);
  return row < kNames.size() ? kNames[row] : "unknown";
}

double minimumJerk(double s) noexcept {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 + s * (-15 + 6 * s));
}

double minimumJerkRate(double s) noexcept {
  s = std::clamp(s, 0.0, 1.0);
  return 30 * s * s * (1 - s) * (1 - s);
}

double handDamping(const OperatorHabits& habits, double k, double m) noexcept {
  return 2 * habits.damping_ratio * std::sqrt(k * m);
}

HandForce evenHand(const OperatorHabits& habits) noexcept {
  HandForce hand;
  hand.k_N_per_m = habits.k_N_per_m * Mat3::Identity();
  hand.b_Ns_per_m = handDamping(habits, habits.k_N_per_m, habits.mass_kg) * Mat3::Identity();
  hand.k_Nm_per_rad = habits.k_Nm_per_rad * Mat3::Identity();
  hand.b_Nms_per_rad = handDamping(habits, habits.k_Nm_per_rad, habits.inertia_kgm2) * Mat3::Identity();
  hand.mass_kg = habits.mass_kg;
  hand.inertia_kgm2 = habits.inertia_kgm2;
  return hand;
}

Vec3 sagBelowHand_m(const OperatorHabits& habits, const Vec3& weight_W, double give_m_per_N) noexcept {
  constexpr double kHeavy = 0.5;  // sag of a heavy part, as a share of see_limit_m; assumed
  const Vec3 sag_m = give_m_per_N * weight_W;
  return sag_m.norm() > kHeavy * habits.see_limit_m ? sag_m : Vec3(Vec3::Zero());
}

VirtualOperator::VirtualOperator(const OperatorHabits& habits) : person_(std::make_unique<Person>(habits)) {}
VirtualOperator::VirtualOperator(VirtualOperator&&) noexcept = default;
VirtualOperator& VirtualOperator::operator=(VirtualOperator&&) noexcept = default;
VirtualOperator::~VirtualOperator() = default;

void VirtualOperator::begin(const OperatorTask& task, double now_s) {
  person_->begin(task, now_s);
}
HandForce VirtualOperator::step(const OperatorView& view, double dt_s) noexcept {
  return person_->step(view, dt_s);
}
Vec3 VirtualOperator::regraspTurn_rad() const noexcept {
  return person_->regraspTurn_rad();
}
void VirtualOperator::goOn() noexcept {
  person_->goOn();
}
OperatorPhase VirtualOperator::phase() const noexcept {
  return person_->phase();
}
OperatorStrategy VirtualOperator::strategy() const noexcept {
  return person_->strategy();
}
int VirtualOperator::retries() const noexcept {
  return person_->retries();
}
const OperatorHabits& VirtualOperator::habits() const noexcept {
  return person_->habits();
}

}  // namespace vps::device
