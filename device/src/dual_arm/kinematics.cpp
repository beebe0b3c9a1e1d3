// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/kinematics.h"

#include <algorithm>
#include <cmath>

namespace vps::device {
namespace {

// Cosine or metres; below this value a joint rate exceeds a million times the handle's.
constexpr double kSingular = 1e-6;

Mat3 columns(const Vec3& x, const Vec3& y, const Vec3& z) {
  Mat3 m;
  m << x, y, z;
  return m;
}

// Orthogonal directions in which t1, t2 and d3 move the arm's end.
struct ArmAxes {
  Vec3 e1, e2, e3;
};

ArmAxes armAxes(const ArmJoints& joints) {
  const double c1 = std::cos(joints.t1_rad), s1 = std::sin(joints.t1_rad);
  const double c2 = std::cos(joints.t2_rad), s2 = std::sin(joints.t2_rad);
  return {{-s1, c1, 0}, {-s2 * c1, -s2 * s1, c2}, {c2 * c1, c2 * s1, s2}};
}

// The Jacobian's columns are orthogonal, so that its inverse has a closed form.
bool armInverseJacobian(const ArmJoints& joints, Mat3& J_inverse) {
  const double c2 = std::cos(joints.t2_rad);
  if (c2 < kSingular || joints.d3_m < kSingular) return false;
  const ArmAxes a = armAxes(joints);
  J_inverse.row(0) = a.e1.transpose() / (joints.d3_m * c2);
  J_inverse.row(1) = a.e2.transpose() / joints.d3_m;
  J_inverse.row(2) = a.e3.transpose();
  return true;
}

// Geometry of arms and gimbal at one pose of the handle, in D.
struct Configuration {
  DualArmJoints joints;
  Mat3 R_DL, R_DR;       // arm bases
  Mat3 J_left, J_right;  // Jacobians of the arms, each in its base frame
  Mat3 J_left_inverse, J_right_inverse;
  Mat3 J_barrel;          // angular, of the left barrel, in the left base frame
  Vec3 p_HL, p_HR, p_EH;  // vectors from H to the gimbal centres, and from E to H
  Vec3 Y, z3, n;          // handle axis, barrel axis, and the direction in which the gimbal transmits torque
  double q2_rad = 0, cos_q2 = 1;
};

Status configure(const DualArmParameters& parameters, const Pose& X_DH, Configuration& c) {
  if (!X_DH.isFinite()) return Status::BadPose;
  const Pose X_DL = armBase(parameters, Side::Left), X_DR = armBase(parameters, Side::Right);
  c.R_DL = X_DL.R;
  c.R_DR = X_DR.R;
  c.Y = X_DH.R.col(1);
  c.p_EH = X_DH.R * parameters.p_EH;
  c.p_HL = -c.p_EH - 0.5 * parameters.handle_m * c.Y;
  c.p_HR = -c.p_EH + 0.5 * parameters.handle_m * c.Y;
  if (armInverse(X_DL.inverse() * Vec3(X_DH.p + c.p_HL), c.joints.left) != Status::Ok)
    return Status::Singular;
  if (armInverse(X_DR.inverse() * Vec3(X_DH.p + c.p_HR), c.joints.right) != Status::Ok)
    return Status::Singular;
  if (!armInverseJacobian(c.joints.left, c.J_left_inverse)) return Status::Singular;
  if (!armInverseJacobian(c.joints.right, c.J_right_inverse)) return Status::Singular;
  c.J_left = armJacobian(c.joints.left);
  c.J_right = armJacobian(c.joints.right);
  c.J_barrel = armAngularJacobian(c.joints.left);

  const Mat3 R_D3 = barrelRotation(parameters, c.joints.left);
  double q1_rad = 0;
  if (gimbalAngles(R_D3.transpose() * c.Y, q1_rad, c.q2_rad) != Status::Ok) return Status::Singular;
  c.cos_q2 = std::cos(c.q2_rad);
  const Mat3 R_spin = gimbalRotation(q1_rad, c.q2_rad, 0).transpose() * R_D3.transpose() * X_DH.R;
  c.joints.q3_rad = std::atan2(R_spin(0, 2), R_spin(0, 0));
  c.z3 = R_D3.col(2);
  c.n = R_D3 * Vec3(-std::cos(q1_rad), -std::sin(q1_rad), 0);
  return Status::Ok;
}

bool isWithin(const DualArmParameters& parameters, const ArmJoints& joints) {
  return std::abs(joints.t1_rad) <= parameters.plate_max_rad &&
         std::abs(joints.t2_rad) <= parameters.plate_max_rad && joints.d3_m >= parameters.reach_min_m &&
         joints.d3_m <= parameters.reach_max_m;
}

// Least distance between segments a + s u and b + t v, s and t in [0, 1]; neither of zero length.
double segmentDistance(const Vec3& a, const Vec3& u, const Vec3& b, const Vec3& v) {
  const Vec3 r = a - b;
  const double uu = u.dot(u), vv = v.dot(v), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
  const double det = uu * vv - uv * uv;
  // Parallel segments may start at any s; the clamps below correct it.
  double s = det > 1e-12 * uu * vv ? std::clamp((uv * vr - vv * ur) / det, 0.0, 1.0) : 0.0;
  const double t = std::clamp((uv * s + vr) / vv, 0.0, 1.0);
  s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
  return (r + s * u - t * v).norm();
}

Pose between(const DualArmParameters& parameters, DeviceFrame from, DeviceFrame to) {
  return framePose(parameters, to).inverse() * framePose(parameters, from);
}

}  // namespace

JointVector toVector(const DualArmJoints& joints) noexcept {
  const ArmJoints &l = joints.left, &r = joints.right;
  JointVector v;
  v << l.t1_rad, l.t2_rad, l.d3_m, r.t1_rad, r.t2_rad, r.d3_m, joints.q3_rad;
  return v;
}

DualArmJoints fromVector(const JointVector& v) noexcept {
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
}

JointVector jointVector(double plate, double link, double rotor) noexcept {
  JointVector v;
  v << plate, plate, link, plate, plate, link, rotor;
  return v;
}

Vec3 armPosition(const ArmJoints& joints) noexcept {
  return joints.d3_m * armAxes(joints).e3;
}

Status armInverse(const Vec3& p_A, ArmJoints& joints) noexcept {
  if (!p_A.allFinite()) return Status::BadPose;
  const double across_m = std::hypot(p_A.x(), p_A.y());
  if (across_m < kSingular) return Status::Singular;
  joints = {std::atan2(p_A.y(), p_A.x()), std::atan2(p_A.z(), across_m), p_A.norm()};
  return Status::Ok;
}

Mat3 armJacobian(const ArmJoints& joints) noexcept {
  const ArmAxes a = armAxes(joints);
  return columns(joints.d3_m * std::cos(joints.t2_rad) * a.e1, joints.d3_m * a.e2, a.e3);
}

Mat3 armAngularJacobian(const ArmJoints& joints) noexcept {
  // Plate rotation Rz(t1) Ry(-t2): t1 turns about z, t2 about -y of the turned plate; d3 only slides.
  return columns(Vec3::UnitZ(), -armAxes(joints).e1, Vec3::Zero());
}

Pose armBase(const DualArmParameters& parameters, Side side) noexcept {
  const double sign = side == Side::Left ? 1 : -1;
  const Mat3 R = columns({0, sign, 0}, {-sign, 0, 0}, {0, 0, 1});
  const Pose X_DA(R, Vec3(0, -sign * parameters.base_m, 0));
  if (side == Side::Left) return X_DA;
  return X_DA * Pose(rotationFromVector(parameters.right_turn_rad), parameters.right_shift_m);
}

Mat3 barrelRotation(const DualArmParameters& parameters, const ArmJoints& left) noexcept {
  // The barrel is fixed to the plate such that the paper's equation (6) at q = 0 and t = 0 gives the identity
  // for the handle in D. The barrel's axis z3, along which the handle is singular, then is horizontal and
  // perpendicular to the arm.
  const Mat3 R_plate_3 = columns({-1, 0, 0}, {0, 0, -1}, {0, -1, 0});
  const ArmAxes a = armAxes(left);
  const Mat3 R_A_plate = columns(a.e3, a.e1, a.e2);
  return armBase(parameters, Side::Left).R * R_A_plate * R_plate_3;
}

const char* toText(DeviceFrame frame) noexcept {
  switch (frame) {
    case DeviceFrame::Independent:
      return "independent";
    case DeviceFrame::Left:
      return "left";
    case DeviceFrame::Right:
      return "right";
  }
  return "unknown";
}

Pose framePose(const DualArmParameters& parameters, DeviceFrame frame) noexcept {
  if (frame == DeviceFrame::Independent) return {};
  return armBase(parameters, frame == DeviceFrame::Left ? Side::Left : Side::Right);
}

Pose inFrame(const DualArmParameters& parameters, const Pose& X, DeviceFrame from, DeviceFrame to) noexcept {
  return between(parameters, from, to) * X;
}

Twist inFrame(const DualArmParameters& parameters, const Twist& V, DeviceFrame from,
              DeviceFrame to) noexcept {
  const Mat3 R = between(parameters, from, to).R;
  return {R * V.w, R * V.v};
}

Wrench inFrame(const DualArmParameters& parameters, const Wrench& F, DeviceFrame from,
               DeviceFrame to) noexcept {
  return rotated(between(parameters, from, to).R, F);
}

Mat3 gimbalRotation(double q1_rad, double q2_rad, double q3_rad) noexcept {
  const double c1 = std::cos(q1_rad), s1 = std::sin(q1_rad), c2 = std::cos(q2_rad), s2 = std::sin(q2_rad);
  const double c3 = std::cos(q3_rad), s3 = std::sin(q3_rad);
  Mat3 R;
  R << c1 * s2 * c3 - s1 * s3, -c1 * c2, c1 * s2 * s3 + s1 * c3,  //
      s1 * s2 * c3 + c1 * s3, -s1 * c2, s1 * s2 * s3 - c1 * c3,   //
      c2 * c3, s2, c2 * s3;
  return R;
}

Status gimbalAngles(const Vec3& Y_3, double& q1_rad, double& q2_rad) noexcept {
  q1_rad = q2_rad = 0;
  if (!Y_3.allFinite()) return Status::BadPose;
  // atan2 with the hypotenuse equals asin for a unit vector, and keeps its precision near 90 deg.
  const double cos_q2 = std::hypot(Y_3.x(), Y_3.y());
  q2_rad = std::atan2(Y_3.z(), cos_q2);
  if (cos_q2 < kSingular) return Status::Singular;
  // Column 2 of the paper's equation (6) is (-c1 c2, -s1 c2, s2): both signs are negative; equation (7) as
  // printed is right in half the plane only.
  q1_rad = std::atan2(-Y_3.y(), -Y_3.x());
  return Status::Ok;
}

Status handlePose(const DualArmParameters& parameters, const DualArmJoints& joints, Pose& X_DH) noexcept {
  const Vec3 p_L = armBase(parameters, Side::Left) * armPosition(joints.left);
  const Vec3 p_R = armBase(parameters, Side::Right) * armPosition(joints.right);
  const Vec3 p_LR = p_R - p_L;
  const double length_m = p_LR.norm();
  if (!std::isfinite(length_m) || !std::isfinite(joints.q3_rad)) return Status::BadPose;
  if (length_m < kSingular) return Status::Singular;
  const Mat3 R_D3 = barrelRotation(parameters, joints.left);
  double q1_rad = 0, q2_rad = 0;
  const Status status = gimbalAngles(R_D3.transpose() * (p_LR / length_m), q1_rad, q2_rad);
  if (status != Status::Ok) return status;
  const Mat3 R_DE = R_D3 * gimbalRotation(q1_rad, q2_rad, joints.q3_rad);
  X_DH = {R_DE, Vec3(0.5 * (p_L + p_R) + R_DE * parameters.p_EH)};
  return Status::Ok;
}

Status handleJoints(const DualArmParameters& parameters, const Pose& X_DH, DualArmJoints& joints) noexcept {
  Configuration c;
  const Status status = configure(parameters, X_DH, c);
  if (status == Status::Ok) joints = c.joints;
  return status;
}

Status handleMotion(const DualArmParameters& parameters, const Pose& X_DH, HandleMotion& motion) noexcept {
  Configuration c;
  const Status status = configure(parameters, X_DH, c);
  if (status != Status::Ok) return status;
  motion.joints = toVector(c.joints);
  motion.q2_rad = c.q2_rad;
  // A gimbal centre at p from H moves with v + w x p.
  JointMatrix& J = motion.J;
  const Mat3 left = c.J_left_inverse * c.R_DL.transpose(), right = c.J_right_inverse * c.R_DR.transpose();
  J.block<3, 3>(0, 0) = -left * crossMatrix(c.p_HL);
  J.block<3, 3>(0, 3) = left;
  J.block<3, 3>(3, 0) = -right * crossMatrix(c.p_HR);
  J.block<3, 3>(3, 3) = right;
  // w - w_barrel = z3 q1' + m q2' + Y q3', and n is perpendicular to the passive axes z3 and m, with n . Y =
  // cos q2.
  const Mat3 barrel = c.R_DL * c.J_barrel;
  J.row(6) = -(c.n.transpose() * barrel) * J.topRows<3>();
  J.block<1, 3>(6, 0) += c.n.transpose();
  J.row(6) /= c.cos_q2;
  // sin q2 = Y . z3, and both Y and z3 turn: q2' = (w - w_barrel) . (Y x z3) / cos q2.
  const Vec3 m = c.Y.cross(c.z3) / c.cos_q2;
  motion.J_q2 = -(m.transpose() * barrel) * J.topRows<3>();
  motion.J_q2.head<3>() += m.transpose();
  return Status::Ok;
}

Status handleJacobian(const DualArmParameters& parameters, const Pose& X_DH, JointMatrix& J) noexcept {
  HandleMotion motion;
  const Status status = handleMotion(parameters, X_DH, motion);
  J = motion.J;
  return status;
}

AxisRange axisRange(const DualArmParameters& p, int axis) noexcept {
  if (axis == 2 || axis == 5) return {p.reach_min_m, p.reach_max_m, true};
  const double most_rad = axis == 6 ? p.q3_max_rad : axis == 7 ? p.q2_max_rad : p.plate_max_rad;
  return {-most_rad, most_rad, false};
}

double axisValue(const JointVector& joints, double q2_rad, int axis) noexcept {
  return axis < 7 ? joints[axis] : q2_rad;
}

bool isReachable(const DualArmParameters& parameters, const Pose& X_DH) noexcept {
  Configuration c;
  if (configure(parameters, X_DH, c) != Status::Ok) return false;
  return isWithin(parameters, c.joints.left) && isWithin(parameters, c.joints.right) &&
         std::abs(c.q2_rad) <= parameters.q2_max_rad && std::abs(c.joints.q3_rad) <= parameters.q3_max_rad &&
         armClearance_m(parameters, c.joints) > 0;
}

double armClearance_m(const DualArmParameters& parameters, const DualArmJoints& joints) noexcept {
  const Pose X_DL = armBase(parameters, Side::Left), X_DR = armBase(parameters, Side::Right);
  return segmentDistance(X_DL.p, X_DL.R * armPosition(joints.left), X_DR.p,
                         X_DR.R * armPosition(joints.right)) -
         2 * parameters.link_radius_m;
}

Status motorEfforts(const DualArmParameters& parameters, const Pose& X_DH, const Wrench& F_Ho_D,
                    JointVector& efforts) noexcept {
  efforts.setZero();
  if (!F_Ho_D.isFinite()) return Status::BadPose;
  Configuration c;
  const Status status = configure(parameters, X_DH, c);
  if (status != Status::Ok) return status;
  const Wrench F_E = shifted(F_Ho_D, c.p_EH);
  // The gimbal transmits torque along n only, so that the motor's torque C.Y acts as T_h. The arms give the
  // other torque C - T_h, which has no part along Y: T_h . Y = C . Y. Signs of the couple: (L/2) Y x (f_R -
  // f_L) = Y x (C x Y) = C for C normal to Y.
  const double motor_Nm = F_E.tau.dot(c.Y);
  const Vec3 T_h = motor_Nm / c.cos_q2 * c.n;
  const Vec3 couple_N = (F_E.tau - T_h).cross(c.Y) / parameters.handle_m;
  const Vec3 f_R = 0.5 * F_E.f + couple_N, f_L = 0.5 * F_E.f - couple_N;
  efforts.segment<3>(0) =
      c.J_left.transpose() * (c.R_DL.transpose() * f_L) + c.J_barrel.transpose() * (c.R_DL.transpose() * T_h);
  efforts.segment<3>(3) = c.J_right.transpose() * (c.R_DR.transpose() * f_R);
  efforts[6] = motor_Nm;
  return Status::Ok;
}

Status handleWrench(const DualArmParameters& parameters, const Pose& X_DH, const JointVector& efforts,
                    Wrench& F_Ho_D) noexcept {
  F_Ho_D = {};
  if (!efforts.allFinite()) return Status::BadPose;
  Configuration c;
  const Status status = configure(parameters, X_DH, c);
  if (status != Status::Ok) return status;
  const Vec3 T_h = efforts[6] / c.cos_q2 * c.n;
  const Vec3 left_Nm = efforts.segment<3>(0) - c.J_barrel.transpose() * (c.R_DL.transpose() * T_h);
  const Vec3 f_L = c.R_DL * (c.J_left_inverse.transpose() * left_Nm);
  const Vec3 f_R = c.R_DR * (c.J_right_inverse.transpose() * efforts.segment<3>(3));
  const Wrench F_E{T_h + 0.5 * parameters.handle_m * c.Y.cross(f_R - f_L), f_L + f_R};
  F_Ho_D = shifted(F_E, -c.p_EH);
  return Status::Ok;
}

double saturationScale(const JointVector& bias, const JointVector& wanted,
                       const JointVector& limit) noexcept {
  double scale = 1;
  for (int i = 0; i < 7; ++i) {
    const double room = limit[i] - (wanted[i] >= 0 ? bias[i] : -bias[i]);
    if (room < 0 || std::abs(bias[i]) > limit[i]) return 0;
    if (std::abs(wanted[i]) * scale > room) scale = room / std::abs(wanted[i]);
  }
  return scale;
}

JointVector motorLimits(const DualArmParameters& parameters, double peak_share) noexcept {
  const auto blend = [&](double continuous, double peak) {
    return continuous + peak_share * (peak - continuous);
  };
  const double plate = blend(parameters.plate_torque_Nm, parameters.plate_peak_Nm);
  const double link = blend(parameters.link_force_N, parameters.link_peak_N);
  return jointVector(plate, link, blend(parameters.rotor_torque_Nm, parameters.rotor_peak_Nm));
}

}  // namespace vps::device
