// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/csv.h"

#include <charconv>
#include <cmath>

#include "vps/write_file.h"
#include "vps_scenes/run/result_fields.h"

namespace vps::viewer {

std::string csvLine(const std::vector<std::string>& cells) {
  std::string out;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) out += ',';
    const bool is_quoted = cell.find_first_of(",\"\n\r") != std::string::npos;
    if (is_quoted) out += '"';
    for (const char c : cell) out.append(c == '"' ? 2 : 1, c);
    if (is_quoted) out += '"';
  }
  return out += '\n';
}

std::string csvNumber(double value) {
  if (!std::isfinite(value)) return "NaN";
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

void addColumns(std::vector<std::string>& columns, const std::string& key, const Vec3*) {
  const std::size_t unit = key.rfind('_');
  for (const char* axis : {"_x", "_y", "_z"}) columns.push_back(std::string(key).insert(unit, axis));
}

void addColumns(std::vector<std::string>& columns, const std::string& key, const Pose*) {
  for (const char* end : {"_x_m", "_y_m", "_z_m", "_qx", "_qy", "_qz", "_qw"}) columns.push_back(key + end);
}

void addCells(std::vector<std::string>& cells, const Vec3& v) {
  for (int k = 0; k < 3; ++k) cells.push_back(csvNumber(v[k]));
}

void addCells(std::vector<std::string>& cells, const Pose& X) {
  addCells(cells, X.p);
  const Quat q = X.isFinite() ? X.quaternion() : Quat::Identity();
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) cells.push_back(csvNumber(value));
}

void writeTraceCsv(const std::vector<scenes::TraceRow>& trace, const std::string& file) {
  writeWholeFile(file, toCsv(trace, scenes::kTraceFields));
}

}  // namespace vps::viewer
