// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <exception>
#include <optional>
#include <ostream>

#include "files/html.h"
#include "pages/book_pictures.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/draw/renderer.h"
#include "vps_viewer/report/book.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

using html::Cell;
using html::format;

constexpr const char* kBookStyle = R"(
.sheet { break-after: page; margin-bottom: 56px; } .sheet:last-child { break-after: auto; }
.sheet h2 { margin-top: 0; } .sheet li { max-width: 100ch; }
svg.book { width: 100%; height: auto; display: block; border: 1px solid #e0e0e0; border-radius: 4px; }
@page { size: A4; margin: 12mm; }
@media print { .sheet { margin-bottom: 0; } .sheet h2 { font-size: 17px; } .sheet li { font-size: 11px; line-height: 1.35; }
       .sheet table { margin: 4px 0; } .sheet td, .sheet th { padding-top: 1px; padding-bottom: 1px; font-size: 11px; } }
)";

class BookWriter {
 public:
  BookWriter(std::ostream& out, const scenes::Scene& scene, const scenes::Book& book,
             const BookOptions& options)
      : out_(out),
        book_(book),
        options_(options),
        aspect_(static_cast<double>(options.width) / options.height),
        drawn_(bookMeshes(scene)) {
    if (!options.has_pictures) return;
    try {
      renderer_.emplace(drawn_);
    } catch (const std::runtime_error& error) {  // this machine has no EGL or OpenGL
      missing_ = error.what();
    }
  }

  std::string write() {
    const std::string title = "Instruction book: " + book_.name;
    out_ << html::pageStart(title, kBookStyle);
    writeCover(title);
    for (const scenes::BookChapter& chapter : book_.chapters) {
      std::vector<std::string> in_place = chapter.fixed;
      for (const scenes::BookStep& step : chapter.steps) {
        writeStep(chapter, step, in_place);
        in_place.insert(in_place.end(), step.planned.parts.begin(), step.planned.parts.end());
      }
    }
    writeRest();
    out_ << html::kPageEnd;
    return missing_;
  }

 private:
  void writeCover(const std::string& title) {
    const std::size_t steps = book_.steps();
    out_ << "<section class=\"sheet\" id=\"cover\"><h1>" << escapeHtml(title) << "</h1>\n<p>" << steps
         << (steps == 1 ? " step, " : " steps, ") << book_.parts.size()
         << (book_.parts.size() == 1 ? " part." : " parts.")
         << " Pictures are seen from the front, right and above; the part in hand is blue, and its place at "
            "the "
            "end of the step is transparent in the same blue.";
    if (!book_.blocked.empty())
      out_ << " <b class=\"bad\">No path was found for " << book_.blocked.size()
           << (book_.blocked.size() == 1 ? " part" : " parts") << ": see the last sheet.</b>";
    out_ << "</p>\n";
    if (!missing_.empty())
      out_ << "<p class=\"note\">The pictures are missing: " << escapeHtml(missing_) << "</p>\n";
    if (wantsPicture()) writePicture(coverPicture(drawn_, book_, aspect_));
    writeItems();
    out_ << "</section>\n";
  }

  void writeItems() {
    const bool has_kind =
        std::ranges::any_of(book_.items, [](const scenes::BookItem& item) { return !item.fastener.empty(); });
    const bool has_mass = std::ranges::any_of(
        book_.items, [](const scenes::BookItem& item) { return item.mass_kg.has_value(); });
    std::vector<std::string> header = {"no.", "part", "count", "size [mm]"};
    if (has_kind) header.emplace_back("kind");
    if (has_mass) header.emplace_back("mass of one [g]");
    std::vector<std::vector<Cell>> rows;
    for (const scenes::BookItem& item : book_.items) {
      std::string names;
      for (const std::string& name : item.names) names += (names.empty() ? "" : ", ") + name;
      std::vector<Cell>& row = rows.emplace_back();
      row = {{std::to_string(item.number), "n"},
             {escapeHtml(names), ""},
             {std::to_string(item.names.size()), "n"},
             {format(1e3 * item.size_m.x(), "%.4g") + " × " + format(1e3 * item.size_m.y(), "%.4g") + " × " +
                  format(1e3 * item.size_m.z(), "%.4g"),
              ""}};
      if (has_kind) row.push_back({escapeHtml(item.fastener), ""});
      if (has_mass) row.push_back({item.mass_kg ? format(1e3 * *item.mass_kg, "%.4g") : "", "n"});
    }
    out_ << "<h2>Parts</h2>\n"
         << html::table(header, rows, "items") << "<p class=\"quiet\">Sizes are along the axes of the part."
         << (has_mass
                 ? " Masses follow from the densities of the scene; 7850 kg/m³ (steel) is assumed where the "
                   "scene states none."
                 : "")
         << "</p>\n";
  }

  void writeStep(const scenes::BookChapter& chapter, const scenes::BookStep& step,
                 const std::vector<std::string>& in_place) {
    out_ << "<section class=\"sheet step\" id=\"step_" << step.number << "\"><h2>Step " << step.number
         << " of " << book_.steps() << ": " << escapeHtml(step.planned.name) << "</h2>\n";
    std::string start;
    if (&step == &chapter.steps.front()) {
      start = "Begin with " + listedNames(chapter.fixed);
      if (!chapter.fixed_reason.empty()) start += " (" + chapter.fixed_reason + ")";
      start += ".";
    }
    if (&chapter != &book_.chapters.back()) start = "Subassembly '" + chapter.name + "'. " + start;
    if (!start.empty()) out_ << "<p>" << escapeHtml(start) << "</p>\n";
    if (wantsPicture()) writePicture(stepPicture(drawn_, book_, in_place, step, aspect_));
    writeRows(step);
    out_ << "<ul>\n";
    for (const std::string& line : bookLines(book_, step)) out_ << "<li>" << escapeHtml(line) << "</li>\n";
    out_ << "</ul></section>\n";
  }

  void writeRows(const scenes::BookStep& step) {
    constexpr std::size_t kMostRows = 8;  // so that a step stays on one sheet
    const std::vector<BookRow> all = rowsOf(book_, step);
    std::vector<std::vector<Cell>> rows;
    for (std::size_t i = 0; i < std::min(all.size(), kMostRows); ++i)
      rows.push_back({{std::to_string(all[i].number), "n"},
                      {escapeHtml(listedNames(all[i].names)), ""},
                      {all[i].is_moved ? "<b>is mounted</b>" : "is in place", ""}});
    out_ << html::table({"no.", "part", "in this step"}, rows);
    if (all.size() > kMostRows)
      out_ << "<p class=\"quiet\">" << all.size() - kMostRows << " more rows are not shown.</p>\n";
  }

  void writeRest() {
    out_ << "<section class=\"sheet\" id=\"rest\"><h2>Parts without a path</h2>\n";
    if (book_.blocked.empty()) out_ << "<p>A path was found for every part.</p>\n";
    if (!book_.blocked.empty()) {
      out_ << "<p>No path was found for these parts. They are in place from the beginning in the pictures. "
              "Unless a proof is stated, a path may exist.</p>\n<ul>\n";
      for (const scenes::BlockedPart& part : book_.blocked) {
        const std::string line = "'" + part.name + "'" + withoutPathWords(part, ": no path was found");
        out_ << "<li>" << escapeHtml(line) << ".</li>\n";
      }
      out_ << "</ul>\n";
    }
    if (!book_.left_out.empty()) {
      out_ << "<h2>Parts that are left out</h2>\n<ul>\n";
      for (const scenes::BookLeftOut& part : book_.left_out)
        out_ << "<li>" << escapeHtml("'" + part.name + "': " + part.reason) << ".</li>\n";
      out_ << "</ul>\n";
    }
    out_ << "</section>\n";
  }

  [[nodiscard]] bool wantsPicture() const { return renderer_.has_value(); }

  void writePicture(const BookPicture& picture) {
    if (options_.progress)
      options_.progress("drawing the book",
                        static_cast<double>(pictures_) / static_cast<double>(book_.steps() + 1));
    ++pictures_;
    DrawOptions options;
    options.width = options_.width;
    options.height = options_.height;
    options.show_contacts = options.show_force = options.show_legend = false;
    // The floor of a picture is level only if z is up; the exploded view (without a hand) stands nowhere.
    options.show_ground = picture.snapshot.has_target && book_.up_W.z() > 0.999;
    try {
      const Image image = renderer_->render(picture.snapshot, picture.camera, options);
      out_ << "<figure>" << pictureSvg(picture, pngInText(pngBytes(image)), options_.width, options_.height)
           << "</figure>\n";
    } catch (const std::runtime_error& error) {  // OpenGL is out of memory, or the graphics card was reset
      missing_ = error.what();
      renderer_.reset();
      out_ << "<p class=\"note\">This picture and the later ones are missing: " << escapeHtml(missing_)
           << "</p>\n";
    }
  }

  std::ostream& out_;
  const scenes::Book& book_;
  const BookOptions& options_;
  double aspect_;
  RenderScene drawn_;
  std::optional<Renderer> renderer_;
  std::string missing_;
  std::size_t pictures_ = 0;
};

}  // namespace

std::string writeBook(std::ostream& out, const scenes::Scene& scene, const scenes::Book& book,
                      const BookOptions& options) {
  return BookWriter(out, scene, book, options).write();
}

}  // namespace vps::viewer
