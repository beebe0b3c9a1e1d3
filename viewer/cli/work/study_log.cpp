// SPDX-License-Identifier: BSD-3-Clause
#include "work/study_log.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "output/json_fields.h"
#include "vps/errors.h"
#include "vps_scenes/planning/study_fields.h"

namespace vps::viewer {

namespace {

constexpr const char* kLogKey =
    "vps_study_log";  // key of the first line; its value is the version of the format

/// The line of JSON; numbers have enough digits to be read back with the same bits.
std::string lineOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

scenes::Verdict verdictFrom(const std::string& text) {
  for (const scenes::Verdict verdict :
       {scenes::Verdict::Fits, scenes::Verdict::Blocked, scenes::Verdict::NotShown})
    if (text == toText(verdict)) return verdict;
  throw std::runtime_error("verdict");
}

scenes::StudyRun runFrom(const Json& json) {
  scenes::StudyRun run;
  run.run = json.at("run").get<std::size_t>();
  run.verdict = verdictFrom(json.at("verdict").get<std::string>());
  run.part = json.at("part").get<std::string>();
  run.reason = json.at("reason").get<std::string>();
  run.simulated_s = json.at("simulated_s").get<double>();
  run.values = json.at("values").get<std::vector<double>>();
  return run;
}

}  // namespace

std::string studyLine(const scenes::StudyRun& run) {
  return lineOf(toObject(run, scenes::kStudyRunFields));
}

StudyLog::StudyLog(const std::string& file, const std::string& fingerprint,
                   const std::vector<scenes::StudyVariable>& variables)
    : file_(file), fingerprint_(fingerprint), variable_count_(variables.size()) {
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  in.close();
  const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  if (whole == 0 && !text.empty() && text.front() != '{')  // not a log: leave the file unchanged
    throw LoadError(file, "", "is not the log of a study; choose another file for --log");
  std::size_t number = 0;
  for (std::size_t from = 0; from < whole;) {
    const std::size_t to = text.find('\n', from);
    readLine(text.substr(from, to - from), ++number);
    from = to + 1;
  }
  if (whole < text.size()) std::filesystem::resize_file(file, whole);
  out_.reset(std::fopen(file.c_str(), "ab"));
  if (!out_) throw LoadError(file, "", "cannot be written; check the folder and its permissions");
  if (whole > 0) return;
  Json names = Json::array();
  for (const scenes::StudyVariable& variable : variables) names.push_back(variable.name);
  write(lineOf({{kLogKey, 1}, {"study", fingerprint}, {"variables", names}}));
}

void StudyLog::readLine(const std::string& line, std::size_t number) {
  const std::string place = "line " + std::to_string(number);
  const Json json = Json::parse(line, nullptr, false);
  const bool is_head = json.is_object() && json.contains(kLogKey);
  if (number == 1 && !is_head)
    throw LoadError(file_, "", "is not the log of a study; choose another file for --log");
  if (is_head) {
    if (json.value("study", "") == fingerprint_) return;
    throw LoadError(file_, "",
                    place +
                        " begins the log of another study: scene, tolerances, --seed or --geometry differ; "
                        "choose another file for --log");
  }
  try {
    scenes::StudyRun run = runFrom(json);
    if (run.values.size() != variable_count_) throw std::runtime_error("values");
    runs_.push_back(std::move(run));
  } catch (const std::exception&) {
    throw LoadError(file_, "", place + " is damaged; remove that line, and its run is made again");
  }
}

void StudyLog::add(const scenes::StudyRun& run) {
  write(studyLine(run));
}

void StudyLog::write(const std::string& line) {
  const std::string whole = line + "\n";
  if (std::fwrite(whole.data(), 1, whole.size(), out_.get()) != whole.size() || std::fflush(out_.get()) != 0)
    throw LoadError(file_, "", "cannot be written; is the disk full?");
}

}  // namespace vps::viewer
