// SPDX-License-Identifier: BSD-3-Clause
#include "work/book_file.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "vps/errors.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/planning/book.h"
#include "vps_viewer/report/book.h"
#include "vps_viewer/report/pages.h"

namespace vps::viewer {

namespace {

bool isHtml(const std::string& file) {
  return file.ends_with(".html") || file.ends_with(".htm");
}

const std::string& checkedBookName(const std::string& file) {
  if (file.empty() || isHtml(file)) return file;
  if (!file.ends_with(".pdf"))
    throw LoadError(file, "", "is no name for --book; give a name that ends in .html or .pdf");
  if (const std::string missing = missingForPdf(); !missing.empty())
    throw LoadError(file, "", missing + ", or name an .html file");
  return file;
}

/// The check of the planned parts as drawn, without scenery.
scenes::CheckResult checkedForBook(const scenes::Scene& scene, const Progress& progress) {
  std::vector<scenes::DrawnPart> parts = drawnParts(scene);
  std::vector<scenes::DrawnPart> planned;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!scene.parts[i].is_scenery) planned.push_back(std::move(parts[i]));
  return checkAssembly(scene.name, planned, {}, progress);
}

}  // namespace

BookFile::BookFile(const std::string& file, const std::vector<std::string>& inputs)
    : file_(checkedBookName(file)),
      html_(isHtml(file) ? file : "", inputs),
      pdf_(isHtml(file) ? "" : file, inputs) {}

void BookFile::write(const scenes::Scene& scene, const scenes::PlanResult& plan, bool has_density,
                     ProgressBar& bar) {
  if (file_.empty()) return;
  const Progress progress = bar.progress();
  const scenes::Book book = makeBook(scene, plan, checkedForBook(scene, progress), has_density);
  BookOptions options;
  options.progress = progress;
  std::string missing;
  if (isHtml(file_)) {
    std::ofstream out(html_.partial(), std::ios::binary | std::ios::trunc);
    missing = writeBook(out, scene, book, options);
    out.close();
    if (!out) throw LoadError(file_, "", "cannot be written; is the disk full? Choose another place");
    html_.commit();
  } else {
    std::ostringstream out;
    missing = writeBook(out, scene, book, options);
    pdf_.write(out.str());
  }
  bar.clear();
  if (!missing.empty()) warn(file_ + ": pictures are missing: " + missing);
  std::printf("book: %s, %zu %s\n", file_.c_str(), book.steps(), book.steps() == 1 ? "step" : "steps");
}

}  // namespace vps::viewer
