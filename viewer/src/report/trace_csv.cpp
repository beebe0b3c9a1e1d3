// SPDX-License-Identifier: BSD-3-Clause
#include "vps/write_file.h"
#include "vps_scenes/result_fields.h"
#include "vps_viewer/csv.h"
#include "vps_viewer/report.h"

namespace vps::viewer {

void writeTraceCsv(const std::vector<scenes::TraceRow>& trace, const std::string& file) {
  writeWholeFile(file, toCsv(trace, scenes::kTraceFields));
}

}  // namespace vps::viewer
