// SPDX-License-Identifier: BSD-3-Clause
// Results appear complete at the end of a run that succeeded, or not at all; until then the results of an
// earlier run are kept. Symbolic links are followed, and devices and pipes are written directly instead of
// being replaced by a file.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps/write_file.h"

namespace vps::viewer {

/// Throws LoadError if `output` is one of the files that the command reads, even under another name.
void requireNotRead(const std::string& output, const std::vector<std::string>& inputs);

/// One output file. The file is opened when the work starts, so that a file that cannot be written is
/// reported before the work.
class OutputFile {
 public:
  /// Throws LoadError if the file cannot be written, or if it is one of the command's `inputs`. With an
  /// empty name write() does nothing.
  OutputFile(const std::string& file, const std::vector<std::string>& inputs);

  /// The file to write before commit(): a temporary file in the same folder, or the device or pipe itself.
  [[nodiscard]] const std::string& partial() const { return partial_; }
  /// Writes the whole content without committing it: a full disk is then found before any file is replaced.
  void stage(std::string_view bytes);
  /// Writes the whole content and commits it.
  void write(std::string_view bytes);
  /// Moves the temporary file to its place. Throws LoadError.
  void commit();

 private:
  std::string file_, partial_;
  std::optional<WholeFile> whole_;  ///< empty for a device or pipe
};

/// A folder of results, which are moved into place together.
class OutputFolder {
 public:
  /// Makes the folder if it does not exist. Throws LoadError if nothing can be written into it.
  explicit OutputFolder(const std::string& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// The temporary folder for new files until commit().
  [[nodiscard]] const std::string& partial() const { return partial_; }
  /// Writes a new file into the temporary folder.
  void write(const std::string& name, std::string_view bytes) const;
  /// Moves each new file into place and replaces earlier files of the same name. Other files in the folder
  /// are kept.
  void commit();

 private:
  std::string folder_, partial_;
  bool is_new_ = false;
};

/// Adds --pdf.
void addPdfOption(CLI::App& command, std::string& file);

/// Throws LoadError if PDF files cannot be printed on this machine (missingForPdf()).
void requirePdf();
/// Prints the HTML file `page` as the file `pdf`. Throws LoadError if the page cannot be printed, and then
/// keeps an earlier PDF file.
void requirePrinted(const std::string& page, const std::string& pdf);

/// A page as PDF. The object is made before the work, so that a missing Chromium is reported early.
class PdfFile {
 public:
  /// With an empty name nothing is written. Throws as requirePdf() and OutputFile do.
  PdfFile(const std::string& file, const std::vector<std::string>& inputs);
  /// Prints the page. Throws LoadError if the page cannot be printed.
  void write(const std::string& html);

 private:
  std::string file_;
  OutputFile out_;
};

}  // namespace vps::viewer
