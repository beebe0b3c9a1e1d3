// SPDX-License-Identifier: BSD-3-Clause
// vps study: estimates the yield of a procedure whose parts vary within their tolerances.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/planning/study.h"
#include "vps_scenes/run/verdict.h"
#include "vps_viewer/report/pages.h"
#include "work/study_log.h"
#include "work/study_on_dask.h"

namespace vps::viewer {

namespace {

/// Number of tasks: many more than workers, so that no worker is idle for long at the end, and few enough
/// that starting a process for each task costs little.
constexpr std::size_t kDaskTasks = 64;

struct StudyArguments {
  std::string scene;
  FidelityArguments fidelity;
  std::size_t runs = 100, first = 0,
              last = 0;  ///< numbers of the runs to make; without --last up to the last run
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool has_contact = true;
  std::size_t tasks = 0;             ///< value of --print-tasks; 0: not given
  std::optional<std::size_t> only;   ///< value of --repeat
  std::string log, json, html, pdf;  ///< empty: none
  std::string dask;  ///< address of a Dask scheduler; empty: the runs are made on this machine
};

/// The command that makes runs of this study; the caller appends the range of runs.
std::vector<std::string> taskWords(const StudyArguments& given, const std::string& scene) {
  std::vector<std::string> words = {
      "vps", "study", scene, "--runs", std::to_string(given.runs), "--seed", std::to_string(given.seed)};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {name, value});
  };
  if (!given.has_contact) words.emplace_back("--geometry");
  if (given.threads > 0) add("--threads", std::to_string(given.threads));
  add("--fidelity", given.fidelity.preset);
  add("--voxel", given.fidelity.voxel);
  add("--spacing", given.fidelity.spacing);
  add("--sides", given.fidelity.sides);
  return words;
}

/// Whether a shell needs no quotes around the word.
bool isPlain(const std::string& word) {
  return std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '/' || c == '_';
  });
}

/// Prints a command for each task, for a shell, GNU parallel or an array job of Slurm. Each task has its own
/// log.
void printTasks(const StudyArguments& given) {
  const std::string log = given.log.empty() ? "study.jsonl" : given.log;
  std::string common;
  for (const std::string& word : taskWords(given, given.scene))
    common += (common.empty() ? "" : " ") + (isPlain(word) ? word : quoted(word));
  const std::size_t tasks = std::min(given.tasks, given.runs);
  for (std::size_t i = 0; i < tasks; ++i)
    std::printf("%s --first %zu --last %zu --log %s\n", common.c_str(), i * given.runs / tasks,
                (i + 1) * given.runs / tasks - 1, quoted(log + "." + std::to_string(i + 1)).c_str());
}

void printResult(const scenes::StudyResult& result) {
  Table table({"<tolerance", "lower", "upper", "yield if halved [%]", "gain [points]", "+-"});
  for (const scenes::StudyEffect& effect : result.effects)
    table.add({effect.variable.name, deviationText(effect.variable, effect.variable.lower),
               deviationText(effect.variable, effect.variable.upper), fixed(100 * effect.yield_if_halved, 2),
               fixed(100 * effect.gain, 2), fixed(100 * effect.gain_error, 2)});
  std::fputs(table.text().c_str(), stdout);
  std::printf("yield %s %% (95 %%: %s to %s %%): %zu of %zu runs fit, %zu are blocked, %zu are 'not shown'\n",
              fixed(100 * result.yield, 2).c_str(), fixed(100 * result.yield_low, 2).c_str(),
              fixed(100 * result.yield_high, 2).c_str(), result.good, result.runs.size(), result.blocked,
              result.runs.size() - result.good - result.blocked);
}

/// Numbers of the requested runs that are not in the log.
std::vector<std::size_t> missingRuns(const StudyArguments& given, const std::vector<scenes::StudyRun>& done) {
  std::set<std::size_t> known;
  for (const scenes::StudyRun& run : done) known.insert(run.run);
  std::vector<std::size_t> missing;
  for (std::size_t run = given.first; run <= given.last; ++run)
    if (!known.contains(run)) missing.push_back(run);
  return missing;
}

void requireRange(StudyArguments& given, bool has_last) {
  if (!has_last) given.last = given.runs - 1;
  if (given.first > given.last || given.last >= given.runs)
    throw LoadError("", "",
                    "--first and --last are " + std::to_string(given.first) + " and " +
                        std::to_string(given.last) + "; expected numbers of runs, from 0 to " +
                        std::to_string(given.runs - 1));
}

/// Makes one run again and prints its line.
int repeatRun(const scenes::Scene& scene, const std::vector<scenes::StudyVariable>& variables,
              const scenes::StudySettings& settings, const scenes::StudyOptions& options, std::size_t number,
              const std::vector<scenes::StudyRun>& done, ProgressBar& bar) {
  const std::vector<scenes::StudyRun> made = scenes::runStudy(scene, variables, settings, {number}, options);
  throwIfStopped();
  bar.clear();
  const std::string line = studyLine(made.at(0));
  std::printf("%s\n", line.c_str());
  const auto known = std::ranges::find(done, number, &scenes::StudyRun::run);
  if (known == done.end()) return kGood;
  const bool is_same = studyLine(*known) == line;
  std::printf("%s\n", is_same ? "this run has the same bits as in the log"
                              : "this run differs from the run in the log");
  return is_same ? kGood : kBad;
}

int runStudyCommand(StudyArguments given, bool has_last) {
  requireRange(given, has_last);
  if (!given.dask.empty() && given.log.empty())
    throw LoadError("", "", "--dask needs --log FILE, which collects the runs of all workers");
  if (given.tasks > 0) {
    printTasks(given);
    return kGood;
  }
  OutputFile json(given.json, {given.scene, given.log}), html(given.html, {given.scene, given.log});
  PdfFile pdf(given.pdf, {given.scene, given.log});
  requireNotRead(given.log, {given.scene});
  ProgressBar bar;
  scenes::Scene scene =
      sceneFrom(given.scene, given.fidelity, {given.json, given.html, given.pdf, given.log}, {});
  const std::vector<scenes::StudyVariable> variables = scenes::studyVariables(scene);
  const scenes::StudySettings settings{given.seed, given.has_contact, given.threads};
  std::optional<StudyLog> log;
  if (!given.log.empty()) log.emplace(given.log, studyFingerprint(scene, variables, settings), variables);
  std::vector<scenes::StudyRun> runs = log ? log->runs() : std::vector<scenes::StudyRun>{};

  scenes::StudyOptions options;
  options.progress = bar.progress();
  options.warn = warn;
  options.stop = &stopRequested();
  if (given.only) return repeatRun(scene, variables, settings, options, *given.only, runs, bar);
  if (log) options.on_run = [&](const scenes::StudyRun& run) { log->add(run); };
  const std::vector<std::size_t> missing = missingRuns(given, runs);
  if (given.dask.empty()) {
    std::vector<scenes::StudyRun> made = scenes::runStudy(scene, variables, settings, missing, options);
    throwIfStopped();
    runs.insert(runs.end(), made.begin(), made.end());
  } else if (!missing.empty()) {
    bar.clear();
    makeOnDask(given.dask, given.log, taskWords(given, std::filesystem::absolute(given.scene).string()),
               rangesOf(missing, kDaskTasks));
    runs = StudyLog(given.log, studyFingerprint(scene, variables, settings), variables).runs();
  }
  std::erase_if(runs, [&](const scenes::StudyRun& run) { return run.run >= given.runs; });
  const scenes::StudyResult result = sumUpStudy(scene.name, variables, settings, std::move(runs));
  json.write(toJson(result));
  const std::string page = studyPage(result);
  html.write(page);
  bar.clear();
  printResult(result);
  pdf.write(page);  // printed last, so that a failure loses no other result
  // A task makes a share of the runs; the study that sums them up has the verdict.
  const bool is_whole = result.runs.size() == given.runs;
  return is_whole ? scenes::exitStatusOf(result.verdict()) : kGood;
}

}  // namespace

std::function<int()> addStudy(CLI::App& command) {
  const auto given = std::make_shared<StudyArguments>();
  addSceneArgument(command, given->scene);
  command.add_option("--runs", given->runs, "number of runs")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{1}, std::size_t{100000000}));
  command.add_option("--seed", given->seed, "seed of the random deviations")->capture_default_str();
  command.add_flag("!--geometry", given->has_contact,
                   "judge by exact distances alone, without runs of the virtual operator: quick, and the "
                   "yield is an upper bound");
  command
      .add_option("--log", given->log,
                  "file with a line for each run; an interrupted study continues with the runs that are "
                  "missing in it")
      ->type_name("FILE");
  command.add_option("--threads", given->threads, "runs at the same time (default: one for each core)");
  command.add_option("--first", given->first, "make only the runs from this number on");
  const CLI::Option* last = command.add_option("--last", given->last, "make only the runs up to this number");
  command.add_option("--repeat", given->only, "make this run again, print it, and compare it with the log");
  command
      .add_option("--print-tasks", given->tasks,
                  "print this many commands that share the runs, for GNU parallel or Slurm, and end")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  command
      .add_option("--dask", given->dask,
                  "make the runs on the workers of this Dask scheduler, which need vps and the scene's files "
                  "at the same paths")
      ->type_name("ADDRESS");
  command.add_option("--html", given->html, "write an HTML page with histograms")->type_name("FILE");
  addPdfOption(command, given->pdf);
  addFidelityOptions(command, given->fidelity);
  addJsonOption(command, given->json);
  return [given, last] { return runStudyCommand(*given, last->count() > 0); };
}

}  // namespace vps::viewer
