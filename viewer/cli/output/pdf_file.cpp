// SPDX-License-Identifier: BSD-3-Clause
#include "output/pdf_file.h"

#include "vps/errors.h"
#include "vps_viewer/report/pdf.h"

namespace vps::viewer {
namespace {

const std::string& checked(const std::string& file) {
  if (!file.empty()) requirePdf();
  return file;
}

}  // namespace

void addPdfOption(CLI::App& command, std::string& file) {
  command.add_option("--pdf", file, "writes the page as PDF, printed by Chromium")->type_name("FILE");
}

void requirePdf() {
  if (const std::string missing = missingForPdf(); !missing.empty())
    throw LoadError("", "", "--pdf " + missing);
}

void requirePrinted(const std::string& page, const std::string& pdf) {
  OutputFile out(pdf, {page});
  if (const std::string failure = printPdf(page, out.partial()); !failure.empty())
    throw LoadError(pdf, "", "is not made: " + failure);
  out.commit();
}

PdfFile::PdfFile(const std::string& file, const std::vector<std::string>& inputs)
    : file_(checked(file)), out_(file, inputs) {}

void PdfFile::write(const std::string& html) {
  if (file_.empty()) return;
  if (const std::string failure = printPdfOf(html, out_.partial()); !failure.empty())
    throw LoadError(file_, "", "is not made: " + failure);
  out_.commit();
}

}  // namespace vps::viewer
