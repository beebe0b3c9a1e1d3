// SPDX-License-Identifier: BSD-3-Clause
#include "report/gnuplot.h"
#include "vps/write_file.h"
#include "vps_viewer/report.h"

namespace vps::viewer {
namespace {

void addNumbers(std::string& line, const Vec3& v) {
  for (int k = 0; k < 3; ++k) line.append(",").append(gnuplot::number(v[k]));
}

void addPose(std::string& line, const Pose& X) {
  addNumbers(line, X.p);
  const Quat q = X.isFinite() ? X.quaternion() : Quat::Identity();
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) line.append(",").append(gnuplot::number(value));
}

}  // namespace

void writeTraceCsv(const std::vector<scenes::TraceRow>& trace, const std::string& file) {
  std::string text =
      "time_s,step,phase,force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,"
      "part_x_m,part_y_m,part_z_m,part_qx,part_qy,part_qz,part_qw,"
      "proxy_x_m,proxy_y_m,proxy_z_m,proxy_qx,proxy_qy,proxy_qz,proxy_qw,contacts,depth_m\n";
  text.reserve(text.size() + 350 * trace.size());
  for (const scenes::TraceRow& row : trace) {
    text.append(gnuplot::number(row.time_s)).append(",").append(std::to_string(row.step));
    text.append(",").append(std::to_string(row.phase));
    addNumbers(text, row.F_hand_W.f);
    addNumbers(text, row.F_hand_W.tau);
    addPose(text, row.X_WP);
    addPose(text, row.X_W_Proxy);
    text.append(",")
        .append(std::to_string(row.contacts))
        .append(",")
        .append(gnuplot::number(row.depth_m))
        .append("\n");
  }
  writeWholeFile(file, text);
}

}  // namespace vps::viewer
