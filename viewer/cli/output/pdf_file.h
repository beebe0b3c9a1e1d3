// SPDX-License-Identifier: BSD-3-Clause
// --pdf FILE: a command's page as PDF.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "output/output.h"

namespace vps::viewer {

/// Adds --pdf.
void addPdfOption(CLI::App& command, std::string& file);

/// Throws LoadError where nothing can be printed here (missingForPdf()).
void requirePdf();
/// Prints a page. Throws LoadError where that fails; what was there before stays then.
void requirePrinted(const std::string& page, const std::string& pdf);

/// Made before the work, so that what is missing is said before it.
class PdfFile {
 public:
  /// An empty name is no output. Throws as requirePdf() and OutputFile.
  PdfFile(const std::string& file, const std::vector<std::string>& inputs);
  /// Throws LoadError where it fails.
  void write(const std::string& html);

 private:
  std::string file_;
  OutputFile out_;
};

}  // namespace vps::viewer
