// SPDX-License-Identifier: BSD-3-Clause
// The criteria of one run of a row, and their outcome.
#pragma once

#include <string>

namespace vps::stability {

/// Collects the criteria of one run; the run holds if all of them are met. A value that is not finite
/// violates its criterion.
class Judgement {
 public:
  void atMost(const std::string& what, double value, double bound, const char* unit);
  void require(bool is_so, const std::string& otherwise);
  /// Reported with the result, not judged.
  void note(const std::string& text);

  [[nodiscard]] bool holds() const { return broken_.empty(); }
  /// All violated criteria; or the criterion nearest to its bound, and the notes.
  [[nodiscard]] std::string text() const;

 private:
  std::string broken_, nearest_, notes_;
  double share_ = -1;  ///< value over bound of the nearest criterion
};

/// "3.2e-06": three digits, in the shortest form.
std::string toText(double value);

}  // namespace vps::stability
