// SPDX-License-Identifier: BSD-3-Clause
// The rows of the stability table, each a scene in which one quantity is increased or decreased to its
// extreme, and the criteria by which a run of a row is judged.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dynamics/engine.h"

namespace vps::stability {

using dynamics::Mode;

/// Collects the criteria of one run; the run holds if all of them are met. A value that is not finite
/// violates its criterion.
class Judgement {
 public:
  void atMost(const std::string& what, double value, double bound, const char* unit);
  void require(bool is_so, const std::string& otherwise);
  /// Adds a text that is reported with the result and not judged.
  void note(const std::string& text);

  [[nodiscard]] bool holds() const { return broken_.empty(); }
  /// All violated criteria, or the criterion nearest to its bound; then the notes.
  [[nodiscard]] std::string text() const;

 private:
  std::string broken_, nearest_, notes_;
  double share_ = -1;  ///< value over bound of the nearest criterion
};

/// The value with three digits, in the shortest form: "3.2e-06".
std::string toText(double value);

struct Run {
  Mode mode = Mode::Constraint;
  double value = 0;          ///< value of the row's quantity
  bool is_thorough = false;  ///< rests for hours instead of seconds
};

struct Row {
  std::string key;
  std::string extreme;  ///< the quantity, with its unit
  std::string judged;   ///< criteria in addition to those of every run (watch.h)
  /// Values from harmless to extreme. The first `promised` are always run, the others until one fails.
  std::vector<double> ladder;
  std::size_t promised = 0;
  std::function<Judgement(const Run&)> run;
  /// How many promised values must hold with constraint and with penalty contact. Fewer than promised is a
  /// known limit, explained in README.md.
  std::size_t holds[2] = {99, 99};
  /// Name of a value, if values are cases. Otherwise they are numbers, and the limit is narrowed between
  /// them.
  std::function<std::string(double)> label = nullptr;
};

// The rows of the table; each function is in the source of its name, scale_rows.cpp and so on.
std::vector<Row> scaleRows();   ///< sizes, distances, steps
std::vector<Row> loadRows();    ///< masses, stiffness, friction, many contacts
std::vector<Row> impactRows();  ///< impacts, thin walls, spin
std::vector<Row> shapeRows();   ///< edges, tips, overlaps at the start, fits
std::vector<Row> restRows();    ///< long rest, copies of a scene
std::vector<Row> inputRows();   ///< values that are not finite
std::vector<Row> deviceRows();  ///< a hand with jerk; if vps::device is built

}  // namespace vps::stability
