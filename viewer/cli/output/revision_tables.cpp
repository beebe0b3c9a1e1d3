// SPDX-License-Identifier: BSD-3-Clause
#include "output/field_table.h"
#include "output/reports.h"
#include "vps_scenes/fits/revision_fields.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

std::string revisionTables(const scenes::RevisionChanges& changes) {
  std::string out =
      "\nchanges from " + changes.old_assembly + " (old) to " + changes.new_assembly + " (new):\n\n";
  const auto add = [&](const auto& rows, const auto& fields) {
    if (!rows.empty()) out += fieldTable(rows, fields) + "\n";
  };
  add(changes.parts, scenes::kPartChangeFields);
  add(changes.pairs, scenes::kPairChangeFields);
  add(changes.fits, scenes::kFitChangeFields);
  add(changes.play, scenes::kPlayChangeFields);
  return out + revisionWords(changes) + "\n";
}

}  // namespace vps::viewer
