// SPDX-License-Identifier: BSD-3-Clause
// A log file with a line of JSON for each run of a study, so that an interrupted study can continue.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "vps_scenes/planning/study.h"

namespace vps::viewer {

/// The line of a run, without the line end.
std::string studyLine(const scenes::StudyRun& run);

/// A log begins with a line that names the study by its fingerprint. Logs of one study may be concatenated; a
/// run that occurs twice counts once.
class StudyLog {
 public:
  /// Opens or creates the log, and reads its runs. An incomplete last line is removed. Throws LoadError if
  /// the file belongs
  /// to another study, is not a log, or cannot be written.
  StudyLog(const std::string& file, const std::string& fingerprint,
           const std::vector<scenes::StudyVariable>& variables);

  [[nodiscard]] const std::vector<scenes::StudyRun>& runs() const { return runs_; }
  /// Appends a run and flushes the file. Throws LoadError if the file cannot be written.
  void add(const scenes::StudyRun& run);

 private:
  void readLine(const std::string& line, std::size_t number);
  void write(const std::string& line);

  std::string file_, fingerprint_;
  std::size_t variable_count_ = 0;
  std::vector<scenes::StudyRun> runs_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out_{nullptr, &std::fclose};
};

}  // namespace vps::viewer
