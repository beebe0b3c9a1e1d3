// SPDX-License-Identifier: BSD-3-Clause
// What one run of a row has to keep to, and what it came to.
#pragma once

#include <string>

namespace vps::stability {

/// Collects the criteria of one run: it holds if all of them do. A value that is not a number breaks any.
class Judgement {
 public:
  void atMost(const std::string& what, double value, double bound, const char* unit);
  void require(bool is_so, const std::string& otherwise);
  /// Told with the result, without being judged.
  void note(const std::string& text);

  [[nodiscard]] bool holds() const { return broken_.empty(); }
  /// What broke, all of it; or the criterion that is nearest to its bound, and the notes.
  [[nodiscard]] std::string text() const;

 private:
  std::string broken_, nearest_, notes_;
  double share_ = -1;  ///< of its bound that the nearest takes up
};

/// "3.2e-06": three digits, as short as they can be said.
std::string toText(double value);

}  // namespace vps::stability
