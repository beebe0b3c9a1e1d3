// SPDX-License-Identifier: BSD-3-Clause
// Plain-text tables, and numbers as text.
#pragma once

#include <string>
#include <vector>

namespace vps::viewer {

/// A text table whose columns are as wide as their widest cell.
class Table {
 public:
  /// @param heads names of the columns; a column whose name begins with '<' is aligned left, others right
  explicit Table(std::vector<std::string> heads);
  void add(std::vector<std::string> cells);
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::vector<bool> is_left_;
};

/// A number with this many digits after the decimal point; "-" if it is not finite.
std::string fixed(double value, int digits);

/// A length in micrometres, without unit.
inline std::string um(double length_m, int digits = 2) {
  return fixed(1e6 * length_m, digits);
}

}  // namespace vps::viewer
