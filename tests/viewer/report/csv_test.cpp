// SPDX-License-Identifier: BSD-3-Clause
// CSV of field tables: columns, and the empty cells of values that were not measured.
#include "vps_viewer/report/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/planning/trade_fields.h"

namespace vps::viewer {
namespace {

TEST(Csv, CellsAreQuotedWhereTheyMust) {
  EXPECT_EQ(csvLine({"a", "b,c", "d\"e", ""}), "a,\"b,c\",\"d\"\"e\",\n");
}

TEST(Csv, NumbersReadBackAsTheSameValue) {
  EXPECT_EQ(csvNumber(0.1), "0.1");
  EXPECT_EQ(std::stod(csvNumber(1.0 / 3)), 1.0 / 3);
  EXPECT_EQ(csvNumber(std::numeric_limits<double>::infinity()), "NaN");
}

TEST(Csv, VectorsAndPosesHaveAColumnForEachNumber) {
  const auto columns = csvColumns<scenes::TraceRow>(scenes::kTraceFields);
  const std::string header = csvLine(columns);
  // Columns that other programs have read since the first version; newer columns are at the end.
  EXPECT_EQ(header,
            "time_s,step,phase,force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,"
            "part_x_m,part_y_m,part_z_m,part_qx,part_qy,part_qz,part_qw,"
            "proxy_x_m,proxy_y_m,proxy_z_m,proxy_qx,proxy_qy,proxy_qz,proxy_qw,contacts,depth_m,"
            "strategy\n");
}

TEST(Csv, WhatWasNotMeasuredHasEmptyCells) {
  scenes::TradeRow probed, run;
  probed.setting.name = "probed";
  probed.has_probe = true;
  probed.probe.force = 0.25;
  run.has_run = true;
  const std::string text = toCsv(std::vector{probed, run}, scenes::kTradeRowFields);
  std::istringstream lines(text);
  std::string header, line;
  std::getline(lines, header);
  EXPECT_NE(header.find(",fidelity_voxel_m,"), std::string::npos) << header;
  EXPECT_NE(header.find(",probe_force_error,"), std::string::npos) << header;
  const auto commas = std::count(header.begin(), header.end(), ',');
  int rows = 0;
  for (; std::getline(lines, line); ++rows)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
  EXPECT_EQ(rows, 2);
  EXPECT_NE(text.find(",0.25,"), std::string::npos) << text;
}

// The order of the lines is what programs have read since the first version.
TEST(Csv, TheNumbersOfACheckHaveTheirPlacesAndErrors) {
  const auto linesOf = [](const auto& of, const auto& fields) {
    std::string out;
    for (const CsvNumber& number : csvNumbers(of, fields))
      out += csvLine({number.object, number.quantity, csvNumber(number.value), csvNumber(number.error)});
    return out;
  };
  scenes::CheckedPair pair;
  pair.clearance_m = 0.25;
  pair.error_m = 0.125;
  pair.volume_error_m3 = 0.5;
  EXPECT_EQ(linesOf(pair, scenes::kCheckedPairFields),
            ",clearance_m,0.25,0.125\n,interference_depth_m,0,0.125\n,interference_volume_m3,0,0.5\n");
  scenes::CheckedFit fit;
  fit.shaft_m = 2;
  fit.bore_m = 1;
  fit.diametral_clearance_m = -1;
  fit.error_m = 0.5;
  fit.press.emplace().force_N = 3;
  EXPECT_EQ(linesOf(fit, scenes::kCheckedFitFields),
            ",diametral_clearance_m,-1,0.5\npress,pressure_Pa,0,NaN\npress,force_N,3,NaN\n"
            "press,declared_force_N,0,NaN\n,shaft_m,2,0.5\n,bore_m,1,0.5\n");
  scenes::CheckedPart part;
  EXPECT_EQ(linesOf(part, scenes::kCheckedPartFields), "");
  part.play.emplace().rad[1] = 2;
  part.play->error_m[0] = 0.5;
  const std::string lines = linesOf(part, scenes::kCheckedPartFields);
  EXPECT_TRUE(lines.starts_with(",play_m +x,0,0.5\n,play_rad +x,0,0\n,play_m -x,0,0\n,play_rad -x,2,0\n"))
      << lines;
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 12);
}

TEST(Csv, NoColumnOccursTwice) {
  for (const auto& columns :
       {csvColumns<scenes::StepResult>(scenes::kStepFields),
        csvColumns<scenes::TradeRow>(std::tuple_cat(scenes::kTradeRowFields, scenes::kTradeRowWallFields))})
    EXPECT_EQ(std::set<std::string>(columns.begin(), columns.end()).size(), columns.size());
}

}  // namespace
}  // namespace vps::viewer
