// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/character.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vps_device/dual_arm/controller.h"
#include "vps_device/dual_arm/statics.h"
#include "vps_device/gains.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat63 = Eigen::Matrix<double, 6, 3>;
using Mat73 = Eigen::Matrix<double, 7, 3>;
using Mat67 = Eigen::Matrix<double, 6, 7>;

constexpr double kPi = std::numbers::pi;
constexpr int kAcross = 9, kAlong = 13;  // places: every 50 mm of the paper's workspace
constexpr int kTilts = 8;                // attitudes of 45 deg about axes across the handle
constexpr double kTilt_rad = kPi / 4;
constexpr int kDirections = 4000;  // of a sphere: 0.003 sr each
constexpr int kFarPoses = 4000;

class Samples {
 public:
  void add(double value) { values_.push_back(value); }
  void addAll(const Vec3& values) {
    for (int i = 0; i < 3; ++i) values_.push_back(values[i]);
  }
  [[nodiscard]] Extent extent() {
    if (values_.empty()) return {};
    std::sort(values_.begin(), values_.end());
    return {values_.front(), values_[values_.size() / 2], values_.back()};
  }

 private:
  std::vector<double> values_;
};

struct DutySamples {
  Samples continuous, peak;
  [[nodiscard]] Duty duty() { return {continuous.extent(), peak.extent()}; }
};

std::vector<Vec3> places(const DualArmParameters& p) {
  std::vector<Vec3> out;
  const auto at = [](int i, int count) { return static_cast<double>(i) / (count - 1) - 0.5; };
  for (int x = 0; x < kAcross; ++x)
    for (int y = 0; y < kAlong; ++y)
      for (int z = 0; z < kAcross; ++z)
        out.push_back(p.workspace_m.cwiseProduct(Vec3(at(x, kAcross), at(y, kAlong), at(z, kAcross))));
  return out;
}

/// Attitude 0 is straight, 1 to kTilts are tilted.
Mat3 attitude(int i) {
  if (i == 0) return Mat3::Identity();
  const double angle = 2 * kPi * i / kTilts;
  return rotationFromVector(kTilt_rad * Vec3(std::cos(angle), 0, std::sin(angle)));
}

/// The pose with the handle's midpoint at p_DE.
Pose poseAt(const DualArmParameters& p, const Vec3& p_DE, const Mat3& R) {
  return {R, Vec3(p_DE + R * p.p_EH)};
}

/// Evenly over the sphere (Fibonacci's spiral).
Vec3 direction(int i, int count) {
  const double z = 1 - (2 * i + 1.0) / count, angle = i * kPi * (3 - std::sqrt(5.0)),
               r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// The smallest rotation that takes Y to a direction. As Eigen's Quaternion::FromTwoVectors(), to the bit,
/// which takes 10 s to compile because it decomposes a matrix where the direction is -Y; here that is half a
/// turn about X.
Mat3 turnFromY(const Vec3& to) {
  const Vec3 unit = to.normalized();
  const double cosine = unit.dot(Vec3::UnitY());
  if (cosine < -1 + 1e-12) return Quat(0, 1, 0, 0).toRotationMatrix();
  const double s = std::sqrt((1 + cosine) * 2), inverse_s = 1 / s;
  Quat turn;
  turn.vec() = Vec3::UnitY().cross(unit) * inverse_s;
  turn.w() = s * 0.5;
  return turn.normalized().toRotationMatrix();
}

/// Solid angle [sr] of reachable handle directions, with the best rotation of the handle about its own axis.
double solidAngle(const DualArmParameters& p, const Vec3& p_DE) {
  int reached = 0;
  for (int i = 0; i < kDirections; ++i) {
    const Mat3 R = turnFromY(direction(i, kDirections));
    Pose X_DH = poseAt(p, p_DE, R);
    DualArmJoints joints;
    if (handleJoints(p, X_DH, joints) != Status::Ok) continue;
    X_DH = poseAt(p, p_DE, R * rotationFromVector(Vec3(0, -joints.q3_rad, 0)));
    reached += isReachable(p, X_DH) ? 1 : 0;
  }
  return 4 * kPi * reached / kDirections;
}

bool isBoxReached(const DualArmParameters& p, double scale, int attitudes) {
  for (int i = 0; i < 27; ++i) {
    const Vec3 corner(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    for (int a = 0; a < attitudes; ++a)
      if (!isReachable(p, poseAt(p, 0.5 * scale * p.workspace_m.cwiseProduct(corner), attitude(a))))
        return false;
  }
  return true;
}

double greatestScale(const DualArmParameters& p, int attitudes) {
  double low = 0, high = 4;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (isBoxReached(p, middle, attitudes) ? low : high) = middle;
  }
  return low;
}

/// Greatest length of a sum of the columns, each forward or backward: the farthest corner of a zonotope.
double farthestCorner(const Eigen::Matrix<double, 3, 7>& columns) {
  double farthest = 0;
  for (int signs = 0; signs < 64; ++signs) {  // the other half is symmetric
    Vec3 sum = columns.col(6);
    for (int i = 0; i < 6; ++i) sum += (signs >> i & 1) != 0 ? Vec3(columns.col(i)) : Vec3(-columns.col(i));
    farthest = std::max(farthest, sum.norm());
  }
  return farthest;
}

/// Derivative of the measured pose (1)-(8) by each encoder: (rotation, shift) per rad or m. Central
/// differences.
Mat67 readingMap(const DualArmParameters& p, const JointVector& joints) {
  constexpr double kStep = 1e-6;
  Mat67 map = Mat67::Zero();
  for (int i = 0; i < 7; ++i) {
    Pose ahead, behind;
    const JointVector step = kStep * JointVector::Unit(i);
    if (handlePose(p, fromVector(joints + step), ahead) != Status::Ok) continue;
    if (handlePose(p, fromVector(joints - step), behind) != Status::Ok) continue;
    map.col(i) << rotationVector(ahead.R * behind.R.transpose()), ahead.p - behind.p;
  }
  return map / (2 * kStep);
}

Vec3 eigenvalues(const Mat3& m) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvalues();
}

/// Half axes of the ellipsoid of forces with sum of (effort / limit)^2 = 1.
Vec3 forceAxes(const Eigen::MatrixXd& efforts, const Eigen::VectorXd& limits) {
  const Eigen::MatrixXd shares = limits.cwiseInverse().asDiagonal() * efforts;
  return eigenvalues(shares.transpose() * shares).cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
}

/// All samples of one run over places and attitudes.
class Survey {
 public:
  explicit Survey(const DualArmParameters& parameters)
      : p_(parameters),
        continuous_(motorLimits(parameters, 0)),
        peak_(motorLimits(parameters, 1)),
        half_step_(0.5 *
                   jointVector(parameters.plate_step_rad, parameters.link_step_m, parameters.rotor_step_rad)),
        inertia_(jointVector(parameters.plate_kgm2, parameters.link_kg, parameters.rotor_kgm2)),
        coulomb_(jointVector(parameters.plate_coulomb_Nm, parameters.link_coulomb_N,
                             parameters.rotor_coulomb_Nm)) {}

  void visit(const Pose& X_DH, bool is_straight);
  void visitFar(const Pose& X_DH);
  void visitArm(const Vec3& p_DE);
  void finish(DualArmCharacter& c);

 private:
  void addMotors(const EffortMap& map, bool is_straight);
  void addMechanics(const Pose& X_DH, const HandleMotion& motion, bool is_straight);
  void addReading(const JointVector& joints, Samples& shift, Samples& turn) const;

  const DualArmParameters& p_;
  JointVector continuous_, peak_, half_step_, inertia_, coulomb_;
  DutySamples straight_force_, force_, straight_torque_, torque_, any_force_, any_torque_;
  DutySamples up_, left_, right_, sum_;
  Samples held_, free_, mass_, rotary_, shift_, turn_, far_shift_, far_turn_, friction_;
  Samples load_, arm_load_, even_, arm_even_, arm_manipulability_, mean_, straight_clearance_,
      tilted_clearance_, far_clearance_;
};

void Survey::addMotors(const EffortMap& map, bool is_straight) {
  const auto add = [&](const Mat73& efforts, DutySamples& worst, DutySamples& straight, DutySamples& any) {
    const double continuous = leastOverDirections(efforts, map.weight, continuous_);
    const double peak = leastOverDirections(efforts, map.weight, peak_);
    worst.continuous.add(continuous);
    worst.peak.add(peak);
    if (is_straight) straight.continuous.add(continuous);
    if (is_straight) straight.peak.add(peak);
    for (int i = 0; i < 26; ++i) {
      const int code = i < 13 ? i : i + 1;
      const Vec3 u = Vec3(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).normalized();
      any.continuous.add(alongDirection(efforts, map.weight, continuous_, u));
      any.peak.add(alongDirection(efforts, map.weight, peak_, u));
    }
  };
  add(map.force, force_, straight_force_, any_force_);
  add(map.torque, torque_, straight_torque_, any_torque_);
  if (!is_straight) return;
  double plate = 0;
  for (const int i : {0, 1, 3, 4}) plate = std::max(plate, map.force.row(i).norm());
  load_.add(plate);
  const Vec3 axes = forceAxes(map.force, continuous_);
  even_.add(axes.minCoeff() / axes.maxCoeff());
  mean_.add(std::cbrt(axes.prod()));
}

void Survey::addMechanics(const Pose& X_DH, const HandleMotion& motion, bool is_straight) {
  const Mat6 K = motion.J.transpose() * structureStiffness(p_, motion.joints).asDiagonal() * motion.J;
  Mat6 M = motion.J.transpose() * inertia_.asDiagonal() * motion.J;
  M.topLeftCorner<3, 3>() += X_DH.R * p_.handle_kgm2.asDiagonal() * X_DH.R.transpose();
  M.bottomRightCorner<3, 3>().diagonal().array() += p_.handle_kg;
  const Mat6 compliance = K.inverse(), mobility = M.inverse();
  held_.addAll(eigenvalues(K.bottomRightCorner<3, 3>()));
  free_.addAll(eigenvalues(compliance.bottomRightCorner<3, 3>()).cwiseInverse());
  mass_.addAll(eigenvalues(mobility.bottomRightCorner<3, 3>()).cwiseInverse());
  rotary_.addAll(eigenvalues(mobility.topLeftCorner<3, 3>()).cwiseInverse());
  const double clearance_m = armClearance_m(p_, fromVector(motion.joints));
  (is_straight ? straight_clearance_ : tilted_clearance_).add(clearance_m);
  if (!is_straight) return;
  for (int i = 0; i < 13; ++i) {
    const Vec3 u = Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1).normalized();
    friction_.add(coulomb_.dot((motion.J.rightCols<3>() * u).cwiseAbs()));  // power for each m/s
  }
}

void Survey::addReading(const JointVector& joints, Samples& shift, Samples& turn) const {
  const Mat67 errors = readingMap(p_, joints) * half_step_.asDiagonal();
  turn.add(farthestCorner(errors.topRows<3>()));
  shift.add(farthestCorner(errors.bottomRows<3>()));
}

void Survey::visit(const Pose& X_DH, bool is_straight) {
  EffortMap map;
  HandleMotion motion;
  if (effortMap(p_, X_DH, map) != Status::Ok || handleMotion(p_, X_DH, motion) != Status::Ok) return;
  addMotors(map, is_straight);
  addMechanics(X_DH, motion, is_straight);
  addReading(motion.joints, shift_, turn_);
}

void Survey::visitFar(const Pose& X_DH) {
  HandleMotion motion;
  if (handleMotion(p_, X_DH, motion) != Status::Ok || std::abs(motion.q2_rad) > p_.q2_max_rad) return;
  far_clearance_.add(armClearance_m(p_, fromVector(motion.joints)));
  if (!isReachable(p_, X_DH)) return;
  addReading(motion.joints, far_shift_, far_turn_);
}

void Survey::visitArm(const Vec3& p_DE) {
  const auto add = [](DutySamples& samples, double continuous, double peak) {
    samples.continuous.add(continuous);
    samples.peak.add(peak);
  };
  const VerticalForce now = verticalForce(p_, p_DE, continuous_), most = verticalForce(p_, p_DE, peak_);
  add(left_, now.left_N, most.left_N);
  add(right_, now.right_N, most.right_N);
  add(up_, now.both_N, most.both_N);
  add(sum_, now.sum_N, most.sum_N);
  // One arm alone, at the position of its gimbal on the straight handle.
  ArmJoints joints;
  const Vec3 p_A = armBase(p_, Side::Left).inverse() * Vec3(p_DE - Vec3(0, 0.5 * p_.handle_m, 0));
  if (armInverse(p_A, joints) != Status::Ok) return;
  const Mat3 efforts = armJacobian(joints).transpose();
  const Vec3 limits = continuous_.head<3>();
  arm_manipulability_.add(std::abs(efforts.determinant()));
  arm_load_.add(efforts.topRows<2>().rowwise().norm().maxCoeff());
  const Vec3 axes = forceAxes(efforts, limits);
  arm_even_.add(axes.minCoeff() / axes.maxCoeff());
}

void Survey::finish(DualArmCharacter& c) {
  c.straight_force_N = straight_force_.duty();
  c.force_N = force_.duty();
  c.straight_torque_Nm = straight_torque_.duty();
  c.torque_Nm = torque_.duty();
  c.any_force_N = any_force_.duty();
  c.any_torque_Nm = any_torque_.duty();
  c.up_N = up_.duty();
  c.left_up_N = left_.duty();
  c.right_up_N = right_.duty();
  c.sum_up_N = sum_.duty();
  c.held_stiffness_N_per_m = held_.extent();
  c.free_stiffness_N_per_m = free_.extent();
  c.mass_kg = mass_.extent();
  c.inertia_kgm2 = rotary_.extent();
  c.resolution_m = shift_.extent();
  c.resolution_rad = turn_.extent();
  c.far_resolution_m = far_shift_.extent();
  c.far_resolution_rad = far_turn_.extent();
  c.friction_N = friction_.extent();
  c.force_ratio = p_.force_N / c.friction_N.median;
  c.peak_force_ratio = p_.force_peak_N / c.friction_N.median;
  const Extent load = load_.extent(), arm_load = arm_load_.extent();
  c.pair_isotropy = load.least / load.greatest;
  c.arm_isotropy = arm_load.least / arm_load.greatest;
  c.ellipsoid_isotropy = even_.extent();
  c.arm_ellipsoid_isotropy = arm_even_.extent();
  c.arm_manipulability_m2 = arm_manipulability_.extent();
  c.pair_force_mean_N = mean_.extent();
  c.straight_clearance_m = straight_clearance_.extent().least;
  c.tilted_clearance_m = tilted_clearance_.extent().least;
  c.far_clearance_m = far_clearance_.extent().least;
}

/// Random directions of the handle anywhere in the workspace. The seed is fixed, so that figures repeat.
void surveyFar(const DualArmParameters& p, Survey& survey) {
  Random random(1);
  for (int i = 0; i < kFarPoses; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3 p_DE = p.workspace_m.cwiseProduct(Vec3(x - 0.5, y - 0.5, z - 0.5));
    const Mat3 R = turnFromY(random.normal3().normalized());
    survey.visitFar(poseAt(p, p_DE, R));
  }
}

void surveyDirections(const DualArmParameters& p, const Progress& progress, DualArmCharacter& c) {
  c.gimbal_sr = 4 * kPi * std::sin(p.q2_max_rad);
  Samples angles;
  for (int i = 0; i < 27; ++i) {
    const Vec3 corner(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const double angle_sr = solidAngle(p, 0.5 * p.workspace_m.cwiseProduct(corner));
    angles.add(angle_sr);
    if (i == 13) c.centre_solid_angle_sr = angle_sr;
    if (progress) progress("directions", i / 27.0);
  }
  c.solid_angle_sr = angles.extent();
}

}  // namespace

DualArmCharacter characterise(const DualArmParameters& p, const Progress& progress) {
  DualArmCharacter c;
  c.workspace_m = p.workspace_m;
  c.straight_scale = greatestScale(p, 1);
  c.tilted_scale = greatestScale(p, 1 + kTilts);
  surveyDirections(p, progress, c);
  Survey survey(p);
  const std::vector<Vec3> all = places(p);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int a = 0; a <= kTilts; ++a) survey.visit(poseAt(p, all[i], attitude(a)), a == 0);
    survey.visitArm(all[i]);
    if (progress) progress("places", static_cast<double>(i) / static_cast<double>(all.size()));
  }
  surveyFar(p, survey);
  survey.finish(c);
  c.limits_1kHz = dualArmLimits(p, 1000, true);
  c.limits_4kHz = dualArmLimits(p, 4000, true);
  c.gains_1kHz = deriveGains(c.limits_1kHz, {1000, 1000, 0, 1, 1});
  c.gains_4kHz = deriveGains(c.limits_4kHz, {4000, 1000, 0, 1, 1});
  return c;
}

std::vector<VerticalForceAt> verticalForces(const DualArmParameters& p, double peak_share) {
  std::vector<VerticalForceAt> out;
  const JointVector limits = motorLimits(p, peak_share);
  for (const Vec3& p_DE : places(p)) out.push_back({p_DE, verticalForce(p, p_DE, limits)});
  return out;
}

}  // namespace vps::device
