// SPDX-License-Identifier: BSD-3-Clause
// vps margin and vps study as a user runs them: tables, logs that were cut, tasks.
#include "program/program.h"

namespace vps {
namespace {

const char* const kTolerance =
    "size_lower = \"-20um\"\nsize_upper = \"20um\"\nposition_tolerance = \"10um\"\n";

class StudyProgram : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    std::string text = kScene;
    const std::string pin = "file = 'pin.stl'\n";
    const std::size_t at = text.find(pin);
    ASSERT_NE(at, std::string::npos) << text;
    text.insert(at + pin.size(), kTolerance);
    write("study.toml", text + "[[step]]\npart = 'pin'\n");
  }
};

constexpr const char* kRun = "study study.toml --geometry --runs 9 --threads 2 ";

TEST_F(StudyProgram, AStudyThatWasCutGoesOnAndNothingIsLostOrCountedTwice) {
  const Ran whole = run(std::string(kRun) + "--log whole.jsonl --json whole.json");
  ASSERT_EQ(whole.status, 0) << whole.err;
  const std::string log = slurp(folder_ / "whole.jsonl");
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 10);  // a head and nine runs
  // Cut at several bytes, in the head and in a run.
  for (const double share : {0.02, 0.3, 0.55, 0.97}) {
    write("cut.jsonl", log.substr(0, static_cast<std::size_t>(share * static_cast<double>(log.size()))));
    const Ran again = run(std::string(kRun) + "--log cut.jsonl --json cut.json");
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(slurp(folder_ / "cut.json"), slurp(folder_ / "whole.json")) << share;
    const std::string cut = slurp(folder_ / "cut.jsonl");
    EXPECT_EQ(std::count(cut.begin(), cut.end(), '\n'), 10) << share;
  }
}

TEST_F(StudyProgram, TasksShareTheRunsAndTheirLogsAreSummedUp) {
  ASSERT_EQ(run(std::string(kRun) + "--json whole.json").status, 0);
  const Ran tasks = run(std::string(kRun) + "--log study.jsonl --print-tasks 2");
  EXPECT_EQ(std::count(tasks.out.begin(), tasks.out.end(), '\n'), 2) << tasks.out;
  std::istringstream lines(tasks.out);
  std::string joined;
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    ASSERT_EQ(line.rfind("vps ", 0), 0U) << line;
    EXPECT_EQ(run(line.substr(4)).status, 0) << line;
    joined += slurp(folder_ / ("study.jsonl." + std::to_string(++count)));
  }
  write("study.jsonl", joined);
  ASSERT_EQ(run(std::string(kRun) + "--log study.jsonl --json joined.json").status, 0);
  EXPECT_EQ(slurp(folder_ / "study.jsonl"), joined);  // nothing was missing
  EXPECT_EQ(slurp(folder_ / "joined.json"), slurp(folder_ / "whole.json"));
}

TEST_F(StudyProgram, ALogOfAnotherStudyAndAFileThatIsNoneAreRefusedAndKept) {
  ASSERT_EQ(run(std::string(kRun) + "--log study.jsonl").status, 0);
  const std::string log = slurp(folder_ / "study.jsonl");
  const Ran other = run(std::string(kRun) + "--seed 2 --log study.jsonl");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("another study"), std::string::npos) << other.err;
  EXPECT_EQ(slurp(folder_ / "study.jsonl"), log);
  write("notes.txt", "not a log, and without an end of line");
  EXPECT_EQ(run(std::string(kRun) + "--log notes.txt").status, 2);
  EXPECT_EQ(slurp(folder_ / "notes.txt"), "not a log, and without an end of line");
  const Ran none = run("study scene.toml --geometry");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("size_tolerance"), std::string::npos) << none.err;
}

TEST_F(StudyProgram, ARunThatIsRepeatedIsTheSameAsInTheLog) {
  ASSERT_EQ(run(std::string(kRun) + "--log study.jsonl").status, 0);
  const Ran same = run(std::string(kRun) + "--log study.jsonl --repeat 5");
  EXPECT_EQ(same.status, 0) << same.out;
  EXPECT_NE(same.out.find("the same as in the log"), std::string::npos) << same.out;
  std::string log = slurp(folder_ / "study.jsonl");
  const std::size_t at = log.find("\"run\":5,\"verdict\":\"");
  ASSERT_NE(at, std::string::npos) << log;
  const std::string seconds = "\"simulated_s\":";
  log.insert(log.find(seconds, at) + seconds.size(), "1");
  write("study.jsonl", log);
  EXPECT_EQ(run(std::string(kRun) + "--log study.jsonl --repeat 5").status, 1);
}

TEST_F(StudyProgram, PagesHaveTheAnswerAndABarForEachStep) {
  const Ran margin = run("margin study.toml --geometry --html margin.html --json margin.json");
  EXPECT_NE(margin.status, 2) << margin.err;
  EXPECT_NE(slurp(folder_ / "margin.html").find("<svg"), std::string::npos);
  EXPECT_NE(slurp(folder_ / "margin.json").find("\"growth_m\""), std::string::npos);
  ASSERT_EQ(run(std::string(kRun) + "--html study.html").status, 0);
  EXPECT_NE(slurp(folder_ / "study.html").find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace vps
