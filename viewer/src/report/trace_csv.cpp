// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/result_fields.h"
#include "vps_viewer/csv.h"
#include "vps_viewer/report.h"
#include "vps_viewer/write_file.h"

namespace vps::viewer {

void writeTraceCsv(const std::vector<scenes::TraceRow>& trace, const std::string& file) {
  writeFileAtomically(file, toCsv(trace, scenes::kTraceFields));
}

}  // namespace vps::viewer
