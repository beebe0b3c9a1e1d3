// SPDX-License-Identifier: BSD-3-Clause
// The runs of a study in a file, a line of JSON for each, so that a study that was cut goes on where it was.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "vps_scenes/planning/study.h"

namespace vps::viewer {

/// The line of a run, without its end.
std::string studyLine(const scenes::StudyRun& run);

/// A log begins with a line that names the study by its fingerprint. Logs of one study may be joined end to
/// end; a run that is there twice counts once.
class StudyLog {
 public:
  /// Opens the log, or begins it, and reads the runs that are there. A last line that is cut is removed.
  /// Throws LoadError where the file holds another study, is no log, or cannot be written.
  StudyLog(const std::string& file, const std::string& fingerprint,
           const std::vector<scenes::StudyVariable>& variables);

  [[nodiscard]] const std::vector<scenes::StudyRun>& runs() const { return runs_; }
  /// Appends a run, which the system has before this returns. Throws LoadError when it cannot.
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
