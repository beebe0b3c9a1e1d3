// SPDX-License-Identifier: BSD-3-Clause
// The differences of two revisions, in words and as a section of the page of a check.
#include <string>
#include <utility>
#include <vector>

#include "files/html.h"
#include "pages/field_table.h"
#include "vps_scenes/fits/revision_fields.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_viewer/report/pages.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

std::string revisionWords(const scenes::RevisionChanges& changes) {
  if (changes.isSame())
    return "nothing changed; the answer is '" + std::string(words(changes.new_verdict)) + "'";
  std::vector<std::string> counts;
  const auto add = [&](std::size_t count, const char* one, const char* more) {
    if (count > 0) counts.push_back(scenes::counted(count, one, more));
  };
  add(changes.parts.size(), "part", "parts");
  add(changes.pairs.size(), "clearance or overlap", "clearances or overlaps");
  add(changes.fits.size(), "fit", "fits");
  add(changes.play.size(), "play", "directions of play");
  std::string out;
  for (std::size_t i = 0; i < counts.size(); ++i)
    out += (i == 0 ? "" : i + 1 == counts.size() ? " and " : ", ") + counts[i];
  out += out.empty() ? "" : " changed; ";
  const std::string was = words(changes.old_verdict), is = words(changes.new_verdict);
  return out + (was == is ? "the answer is still '" + is + "'"
                          : "the answer was '" + was + "' and is '" + is + "'");
}

std::string revisionSection(const scenes::RevisionChanges& changes) {
  std::string out = "<h2>Changes from " + escapeHtml(changes.old_assembly) + " (old) to " +
                    escapeHtml(changes.new_assembly) + " (new)</h2>\n<p class=\"changes\">" +
                    escapeHtml(revisionWords(changes)) +
                    ". A number counts as changed if it differs by more than the sum of its errors in both "
                    "revisions.</p>\n";
  const auto add = [&](const char* heading, const auto& rows, const auto& fields) {
    if (!rows.empty()) out += "<h3>" + std::string(heading) + "</h3>\n" + fieldTableOnPage(rows, fields);
  };
  add("Parts", changes.parts, scenes::kPartChangeFields);
  add("Clearances and overlaps", changes.pairs, scenes::kPairChangeFields);
  add("Fits", changes.fits, scenes::kFitChangeFields);
  add("Play", changes.play, scenes::kPlayChangeFields);
  return out;
}

}  // namespace vps::viewer
