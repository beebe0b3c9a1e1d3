// SPDX-License-Identifier: BSD-3-Clause
// A plain-text table: columns as wide as their widest cell, numbers to the right.
#pragma once

#include <string>
#include <vector>

namespace vps::viewer {

class Table {
 public:
  /// @param heads  column names; one that begins with '<' holds words and is set to the left
  explicit Table(std::vector<std::string> heads);
  void add(std::vector<std::string> cells);
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::vector<bool> is_left_;
};

/// A number with this many digits after the point; "-" if it is not finite.
std::string fixed(double value, int digits);

}  // namespace vps::viewer
