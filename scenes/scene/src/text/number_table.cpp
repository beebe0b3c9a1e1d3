// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/number_table.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

#include "vps/errors.h"

namespace vps::scenes {

std::vector<NumberRow> readNumberTable(const std::string& file, std::size_t columns,
                                       const std::string& what) {
  std::ifstream in(file);
  if (!in) throw LoadError(file, "", "cannot be read; name a table of " + what);
  std::vector<NumberRow> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line.resize(std::min(line.size(), line.find('#')));
    for (char& c : line)
      if (c == ',' || c == ';') c = ' ';
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    NumberRow row = {{}, file + ":" + std::to_string(number)};
    for (double x = 0; words >> x;) row.numbers.push_back(x);
    if (row.numbers.empty() && rows.empty()) continue;  // a heading
    const bool is_finite = std::ranges::all_of(row.numbers, [](double x) { return std::isfinite(x); });
    if (row.numbers.size() != columns || !words.eof() || !is_finite)
      throw LoadError(row.place, "", "expected " + std::to_string(columns) + " numbers: " + what);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::optional<Pose> poseOf(std::span<const double, 7> n) {
  constexpr double kUnit = 1e-3;
  const Quat q(n[6], n[3], n[4], n[5]);
  const Vec3 p(n[0], n[1], n[2]);
  if (!p.allFinite() || !(std::abs(q.norm() - 1) <= kUnit)) return {};
  return Pose(q.normalized(), p);
}

}  // namespace vps::scenes
