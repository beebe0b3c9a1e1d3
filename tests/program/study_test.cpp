// SPDX-License-Identifier: BSD-3-Clause
// vps margin and vps study as a user runs them: tables, logs that were cut, tasks.
#include <thread>

#include "program/program.h"
#include "support/process/child_process.h"

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
  EXPECT_EQ(slurp(folder_ / "study.jsonl"), joined);  // no run was missing
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
  EXPECT_NE(same.out.find("this run has the same bits as in the log"), std::string::npos) << same.out;
  std::string log = slurp(folder_ / "study.jsonl");
  const std::size_t at = log.find("\"run\":5,\"verdict\":\"");
  ASSERT_NE(at, std::string::npos) << log;
  const std::string seconds = "\"simulated_s\":";
  log.insert(log.find(seconds, at) + seconds.size(), "1");
  write("study.jsonl", log);
  EXPECT_EQ(run(std::string(kRun) + "--log study.jsonl --repeat 5").status, 1);
}

/// A Dask scheduler on loopback with two workers that find `vps` on their PATH.
class StudyOnDask : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    if (std::system("dask-scheduler --version >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "dask-scheduler is not installed";
    fs::create_directories(folder_ / "bin");
    fs::create_symlink(VPS_PROGRAM, folder_ / "bin/vps");
    scheduler_ =
        start("exec dask-scheduler --host 127.0.0.1 --port 0 --no-dashboard --scheduler-file scheduler.json");
    ASSERT_TRUE(
        waitFor([&] { return slurp(folder_ / "scheduler.json").find("tcp://") != std::string::npos; }));
    const std::string text = slurp(folder_ / "scheduler.json");
    const std::size_t at = text.find("tcp://");
    address_ = text.substr(at, text.find('"', at) - at);
    for (std::size_t i = 0; i < 2; ++i)
      worker_[i] = start(
          "exec dask-worker --scheduler-file scheduler.json --nthreads 1 --nworkers 1 --no-nanny "
          "--no-dashboard --local-directory worker" +
          std::to_string(i));
    ASSERT_TRUE(waitFor([&] {
      const std::string log = slurp(folder_ / "background.txt");
      return log.find("Registered to", log.find("Registered to") + 1) != std::string::npos;
    })) << slurp(folder_ / "background.txt");
  }

  [[nodiscard]] test::ChildProcess start(const std::string& command) const {
    std::ostringstream line;
    line << "cd " << folder_ << " && PATH=" << folder_ << "/bin:$PATH && " << command;  // paths in quotes
    return {{"/bin/sh", "-c", line.str()}, (folder_ / "background.txt").string()};
  }
  [[nodiscard]] test::ChildProcess startStudy() const {
    return start("exec vps " + std::string(kRun) + "--log dask.jsonl --json dask.json --dask " + address_);
  }
  template <class Condition>
  static bool waitFor(Condition isSo) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!isSo() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return isSo();
  }
  [[nodiscard]] std::ptrdiff_t lines() const {
    const std::string log = slurp(folder_ / "dask.jsonl");
    return std::count(log.begin(), log.end(), '\n');
  }

  test::ChildProcess scheduler_, worker_[2];
  std::string address_;
};

TEST_F(StudyOnDask, AWorkerThatIsKilledLosesNothingAndNothingIsCountedTwice) {
  ASSERT_EQ(run(std::string(kRun) + "--json local.json").status, 0);
  test::ChildProcess study = startStudy();
  ASSERT_TRUE(waitFor([&] { return lines() > 2; }))
      << slurp(folder_ / "background.txt");  // a head and two runs
  worker_[0].killNow();
  EXPECT_EQ(study.wait(), 0) << slurp(folder_ / "background.txt");
  EXPECT_EQ(lines(), 10);
  EXPECT_EQ(slurp(folder_ / "dask.json"), slurp(folder_ / "local.json"));
}

TEST_F(StudyOnDask, ASchedulerThatGoesAwayEndsTheStudyWhichGoesOnLater) {
  ASSERT_EQ(run(std::string(kRun) + "--json local.json").status, 0);
  test::ChildProcess study = startStudy();
  ASSERT_TRUE(waitFor([&] { return lines() > 2; })) << slurp(folder_ / "background.txt");
  scheduler_.killNow();
  EXPECT_EQ(study.wait(), 2);
  EXPECT_NE(slurp(folder_ / "background.txt").find("makes the missing ones"), std::string::npos);
  EXPECT_GT(lines(), 2);
  EXPECT_LT(lines(), 10);
  ASSERT_EQ(run(std::string(kRun) + "--log dask.jsonl --json dask.json").status, 0);  // on this machine
  EXPECT_EQ(lines(), 10);
  EXPECT_EQ(slurp(folder_ / "dask.json"), slurp(folder_ / "local.json"));
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
