// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/character.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "vps_device/dual_arm/controller.h"
#include "vps_device/dual_arm/statics.h"
#include "vps_device/gains.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat73 = Eigen::Matrix<double, 7, 3>;
using Mat67 = Eigen::Matrix<double, 6, 7>;

constexpr double kPi = std::numbers::pi;
constexpr int kAcross = 9, kAlong = 13;  // places: one every 50 mm of the paper's workspace
constexpr int kTilts = 8;                // attitudes of 45 deg about axes across the handle
constexpr double kTilt_rad = kPi / 4;
constexpr int kDirections = 4000;  // directions of a sphere, each for 0.003 sr
constexpr int kFarPoses = 4000;

/// Collects the samples of figures, and makes each figure from its samples.
class Samples {
 public:
  void add(Extent& figure, double value) { samples_[&figure].push_back(value); }
  void add(Extent& figure, const Vec3& values) {
    for (int i = 0; i < 3; ++i) add(figure, values[i]);
  }
  void add(Duty& figure, double continuous, double peak) {
    add(figure.continuous, continuous);
    add(figure.peak, peak);
  }
  void finish() {
    for (auto& [figure, values] : samples_) {
      std::sort(values.begin(), values.end());
      *figure = {values.front(), values[values.size() / 2], values.back()};
    }
  }

 private:
  std::map<Extent*, std::vector<double>> samples_;
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

/// Direction i of `count`, distributed evenly over the sphere (Fibonacci's spiral).
Vec3 direction(int i, int count) {
  const double z = 1 - (2 * i + 1.0) / count, angle = i * kPi * (3 - std::sqrt(5.0)),
               r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// The smallest rotation from Y to a direction. Equal to the bit to Eigen's Quaternion::FromTwoVectors(),
/// which takes 10 s to compile because it decomposes a matrix for the direction -Y; here that case is half a
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

/// Greatest length of a sum of the columns, each with the sign + or -: the farthest corner of a zonotope.
double farthestCorner(const Eigen::Matrix<double, 3, 7>& columns) {
  double farthest = 0;
  for (int signs = 0; signs < 64; ++signs) {  // the other half is symmetric
    Vec3 sum = columns.col(6);
    for (int i = 0; i < 6; ++i) sum += (signs >> i & 1) != 0 ? Vec3(columns.col(i)) : Vec3(-columns.col(i));
    farthest = std::max(farthest, sum.norm());
  }
  return farthest;
}

/// Derivative of the measured pose, the paper's equations (1) to (8), by each encoder: (rotation, shift) per
/// rad or m. Central differences.
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

/// Visits places and attitudes, and writes what it finds to `character`.
class Survey {
 public:
  Survey(const DualArmParameters& parameters, DualArmCharacter& character)
      : p_(parameters),
        c_(character),
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
  void finish();

 private:
  void addMotors(const EffortMap& map, bool is_straight);
  void addMechanics(const Pose& X_DH, const HandleMotion& motion, bool is_straight);
  void addReading(const JointVector& joints, Extent& shift, Extent& turn);

  const DualArmParameters& p_;
  DualArmCharacter& c_;
  JointVector continuous_, peak_, half_step_, inertia_, coulomb_;
  Samples samples_;
  Extent load_, arm_load_, straight_clearance_, tilted_clearance_, far_clearance_;
};

void Survey::addMotors(const EffortMap& map, bool is_straight) {
  const auto add = [&](const Mat73& efforts, Duty& worst, Duty& straight, Duty& any) {
    const double continuous = leastOverDirections(efforts, map.weight, continuous_);
    const double peak = leastOverDirections(efforts, map.weight, peak_);
    samples_.add(worst, continuous, peak);
    if (is_straight) samples_.add(straight, continuous, peak);
    for (int i = 0; i < 26; ++i) {
      const int code = i < 13 ? i : i + 1;
      const Vec3 u = Vec3(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).normalized();
      samples_.add(any, alongDirection(efforts, map.weight, continuous_, u),
                   alongDirection(efforts, map.weight, peak_, u));
    }
  };
  add(map.force, c_.force_N, c_.straight_force_N, c_.any_force_N);
  add(map.torque, c_.torque_Nm, c_.straight_torque_Nm, c_.any_torque_Nm);
  if (!is_straight) return;
  double plate = 0;
  for (const int i : {0, 1, 3, 4}) plate = std::max(plate, map.force.row(i).norm());
  samples_.add(load_, plate);
  const Vec3 axes = forceAxes(map.force, continuous_);
  samples_.add(c_.ellipsoid_isotropy, axes.minCoeff() / axes.maxCoeff());
  samples_.add(c_.pair_force_mean_N, std::cbrt(axes.prod()));
}

void Survey::addMechanics(const Pose& X_DH, const HandleMotion& motion, bool is_straight) {
  const Mat6 K = motion.J.transpose() * structureStiffness(p_, motion.joints).asDiagonal() * motion.J;
  Mat6 M = motion.J.transpose() * inertia_.asDiagonal() * motion.J;
  M.topLeftCorner<3, 3>() += X_DH.R * p_.handle_kgm2.asDiagonal() * X_DH.R.transpose();
  M.bottomRightCorner<3, 3>().diagonal().array() += p_.handle_kg;
  const Mat6 compliance = K.inverse(), mobility = M.inverse();
  samples_.add(c_.held_stiffness_N_per_m, eigenvalues(K.bottomRightCorner<3, 3>()));
  samples_.add(c_.free_stiffness_N_per_m, eigenvalues(compliance.bottomRightCorner<3, 3>()).cwiseInverse());
  samples_.add(c_.mass_kg, eigenvalues(mobility.bottomRightCorner<3, 3>()).cwiseInverse());
  samples_.add(c_.inertia_kgm2, eigenvalues(mobility.topLeftCorner<3, 3>()).cwiseInverse());
  const double clearance_m = armClearance_m(p_, fromVector(motion.joints));
  samples_.add(is_straight ? straight_clearance_ : tilted_clearance_, clearance_m);
  if (!is_straight) return;
  for (int i = 0; i < 13; ++i) {
    const Vec3 u = Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1).normalized();
    // The friction force is the power of friction at 1 m/s.
    samples_.add(c_.friction_N, coulomb_.dot((motion.J.rightCols<3>() * u).cwiseAbs()));
  }
}

void Survey::addReading(const JointVector& joints, Extent& shift, Extent& turn) {
  const Mat67 errors = readingMap(p_, joints) * half_step_.asDiagonal();
  samples_.add(turn, farthestCorner(errors.topRows<3>()));
  samples_.add(shift, farthestCorner(errors.bottomRows<3>()));
}

void Survey::visit(const Pose& X_DH, bool is_straight) {
  EffortMap map;
  HandleMotion motion;
  if (effortMap(p_, X_DH, map) != Status::Ok || handleMotion(p_, X_DH, motion) != Status::Ok) return;
  addMotors(map, is_straight);
  addMechanics(X_DH, motion, is_straight);
  addReading(motion.joints, c_.resolution_m, c_.resolution_rad);
}

void Survey::visitFar(const Pose& X_DH) {
  HandleMotion motion;
  if (handleMotion(p_, X_DH, motion) != Status::Ok || std::abs(motion.q2_rad) > p_.q2_max_rad) return;
  samples_.add(far_clearance_, armClearance_m(p_, fromVector(motion.joints)));
  if (!isReachable(p_, X_DH)) return;
  addReading(motion.joints, c_.far_resolution_m, c_.far_resolution_rad);
}

void Survey::visitArm(const Vec3& p_DE) {
  const VerticalForce now = verticalForce(p_, p_DE, continuous_), most = verticalForce(p_, p_DE, peak_);
  samples_.add(c_.left_up_N, now.left_N, most.left_N);
  samples_.add(c_.right_up_N, now.right_N, most.right_N);
  samples_.add(c_.up_N, now.both_N, most.both_N);
  samples_.add(c_.sum_up_N, now.sum_N, most.sum_N);
  // One arm alone, at the position of its gimbal on the straight handle.
  ArmJoints joints;
  const Vec3 p_A = armBase(p_, Side::Left).inverse() * Vec3(p_DE - Vec3(0, 0.5 * p_.handle_m, 0));
  if (armInverse(p_A, joints) != Status::Ok) return;
  const Mat3 efforts = armJacobian(joints).transpose();
  const Vec3 limits = continuous_.head<3>();
  samples_.add(c_.arm_manipulability_m2, std::abs(efforts.determinant()));
  samples_.add(arm_load_, efforts.topRows<2>().rowwise().norm().maxCoeff());
  const Vec3 axes = forceAxes(efforts, limits);
  samples_.add(c_.arm_ellipsoid_isotropy, axes.minCoeff() / axes.maxCoeff());
}

void Survey::finish() {
  samples_.finish();
  c_.force_ratio = p_.force_N / c_.friction_N.median;
  c_.peak_force_ratio = p_.force_peak_N / c_.friction_N.median;
  c_.pair_isotropy = load_.least / load_.greatest;
  c_.arm_isotropy = arm_load_.least / arm_load_.greatest;
  c_.straight_clearance_m = straight_clearance_.least;
  c_.tilted_clearance_m = tilted_clearance_.least;
  c_.far_clearance_m = far_clearance_.least;
}

/// Visits random directions of the handle, anywhere in the workspace. The seed is fixed, so that figures
/// repeat.
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
  Samples samples;
  for (int i = 0; i < 27; ++i) {
    const Vec3 corner(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const double angle_sr = solidAngle(p, 0.5 * p.workspace_m.cwiseProduct(corner));
    samples.add(c.solid_angle_sr, angle_sr);
    if (i == 13) c.centre_solid_angle_sr = angle_sr;
    if (progress) progress("directions", i / 27.0);
  }
  samples.finish();
}

}  // namespace

DualArmCharacter characterise(const DualArmParameters& p, const Progress& progress) {
  DualArmCharacter c;
  c.workspace_m = p.workspace_m;
  c.straight_scale = greatestScale(p, 1);
  c.tilted_scale = greatestScale(p, 1 + kTilts);
  surveyDirections(p, progress, c);
  Survey survey(p, c);
  const std::vector<Vec3> all = places(p);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int a = 0; a <= kTilts; ++a) survey.visit(poseAt(p, all[i], attitude(a)), a == 0);
    survey.visitArm(all[i]);
    if (progress) progress("places", static_cast<double>(i) / static_cast<double>(all.size()));
  }
  surveyFar(p, survey);
  survey.finish();
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
