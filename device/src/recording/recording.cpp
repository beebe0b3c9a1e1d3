// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/recording.h"

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "recording/log_fields.h"
#include "recording/recording_format.h"
#include "vps/errors.h"

namespace vps::device {

namespace {

namespace fs = std::filesystem;

std::string bytesOf(const std::string& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw LoadError(file, "", "no such file; name a recording (run.mcap)");
  if (fs::is_directory(file, error))
    throw LoadError(file, "", "is a folder; name a recording in it (run.mcap)");
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (in.bad() || !in) throw LoadError(file, "", "cannot be read; check its permissions");
  return bytes;
}

const McapMetadata* metadata(const McapContent& content, std::string_view name) {
  for (const McapMetadata& m : content.metadata)
    if (m.name == name) return &m;
  return nullptr;
}

std::string seconds(double s) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.3f s", s);
  return buffer;
}

RecordingHead headOf(const McapContent& content, const std::string& file) {
  const std::string why =
      content.damage ? content.damage->words + " (byte " + std::to_string(content.damage->at_byte) + ")"
                     : "lacks the head of a recording";
  const McapMetadata *about = metadata(content, recording::kAbout),
                     *device = metadata(content, recording::kDevice);
  if (about == nullptr || device == nullptr)
    throw LoadError(file, "", why + ", so that it cannot be replayed; record the run again");
  RecordingHead head;
  head.about = about->values;
  if (head.about["format"] != recording::kFormat)
    throw LoadError(file, "",
                    "is a recording of format " + head.about["format"] + "; this version reads format " +
                        recording::kFormat);
  const auto name = device->values.find("name");
  if (name != device->values.end()) head.device = name->second;
  recording::eachLimit(head.limits, [&](const std::string& key, double& x) {
    const auto found = device->values.find(key);
    if (found == device->values.end()) return;
    const std::string& text = found->second;
    if (std::from_chars(text.data(), text.data() + text.size(), x).ptr != text.data() + text.size())
      throw LoadError(file, "", "has '" + text + "' instead of a number for the device's " + key);
  });
  head.attachments = content.attachments;
  return head;
}

/// The kind of entry on a channel; kKinds if the channel holds no entries.
std::size_t kindOf(const McapChannel& channel) {
  const std::string_view topic = channel.topic == recording::kOldSyncTopic
                                     ? std::string_view(log::kTopics[log::kSyncKind])
                                     : std::string_view(channel.topic);
  std::size_t kind = 0;
  while (kind < log::kKinds && topic != log::kTopics[kind]) ++kind;
  return kind;
}

/// Reads entries up to the first that is missing or invalid; returns why it stopped there.
std::string readEntries(const McapContent& content, RecordedRun& run) {
  std::uint32_t expected = 0;
  for (const McapMessage& message : content.messages) {
    const std::size_t kind = kindOf(content.channels.at(message.channel));
    if (kind == log::kKinds) continue;
    if (message.sequence != expected)
      return message.sequence > expected ? "lacks " + std::to_string(message.sequence - expected) +
                                               " entries, which came too fast to be written or are damaged"
                                         : "repeats an entry";
    LogEntry entry = log::blank(kind);
    if (!log::decode(message.data, entry)) return "holds a message that does not match its channel";
    run.entries.push_back(entry);
    ++expected;
  }
  const McapMetadata* end = metadata(content, recording::kEnd);
  if (end == nullptr) return content.damage ? "" : "was never finished";
  const auto count = end->values.find("entries");
  if (count != end->values.end() && count->second != std::to_string(expected))
    return "lacks its last entries, which came too fast to be written";
  return "";
}

}  // namespace

const McapAttachment* RecordedRun::attachment(std::string_view name) const {
  for (const McapAttachment& a : head.attachments)
    if (a.name == name) return &a;
  return nullptr;
}

std::size_t RecordedRun::reads() const {
  std::size_t count = 0;
  for (const LogEntry& entry : entries) count += std::holds_alternative<DeviceSample>(entry);
  return count;
}

RecordedRun recordingFrom(std::string_view bytes, const std::string& file) {
  if (!isMcap(bytes))
    throw LoadError(file, "", "is not a recording (MCAP); make one with vps assemble --record");
  const McapContent content = readMcap(bytes);
  if (!content.library.starts_with(recording::kLibrary) && !content.damage)
    throw LoadError(
        file, "",
        "is an MCAP file, but not a recording of this program; it was written by '" + content.library + "'");
  RecordedRun run;
  run.file = file;
  run.head = headOf(content, file);
  std::string why = readEntries(content, run);
  if (why.empty() && content.damage)
    why = content.damage->words + " (byte " + std::to_string(content.damage->at_byte) + " of " +
          std::to_string(bytes.size()) + ")";
  if (why.empty()) return run;
  run.damage = why + "; kept: " + std::to_string(run.reads()) + " device samples" +
               (run.entries.empty() ? "" : ", up to " + seconds(timeOf(run.entries.back())));
  return run;
}

RecordedRun loadRecording(const std::string& file) {
  return recordingFrom(bytesOf(file), file);
}

std::vector<std::pair<std::string, std::string>> csvTables(const RecordedRun& run) {
  std::vector<std::pair<std::string, std::string>> tables;
  for (std::size_t kind = 0; kind < log::kKinds; ++kind) {
    std::string name = log::kTopics[kind] + 1;
    name[name.find('/')] = '_';
    tables.emplace_back(name, log::csvHeader(kind));
  }
  for (const LogEntry& entry : run.entries) tables[entry.index()].second += log::csvRow(entry);
  return tables;
}

Recording::Recording(RecordedRun run) : run_(std::move(run)) {
  std::optional<std::uint8_t> phase;
  for (std::size_t i = 0; i < run_.entries.size(); ++i) {
    if (std::holds_alternative<DeviceSample>(run_.entries[i])) {
      reads_.push_back(i);
      phases_.push_back(phase);
    }
    const auto* event = std::get_if<RunEvent>(&run_.entries[i]);
    if (event != nullptr && event->kind == RunEventKind::Phase) phase = event->phase;
  }
  phases_.push_back(phase);
}

DeviceSample Recording::read() noexcept {
  if (next_ < reads_.size()) return std::get<DeviceSample>(run_.entries[reads_[next_++]]);
  DeviceSample lost = reads_.empty() ? DeviceSample{} : std::get<DeviceSample>(run_.entries[reads_.back()]);
  lost.status = Status::Fault;
  return lost;
}

std::optional<std::uint8_t> Recording::phase() const noexcept {
  return phases_[next_];
}

void ReplayCheck::add(const LogEntry& entry) noexcept {
  if (std::holds_alternative<WrittenWrench>(entry)) ++ticks_;
  if (!departure_.empty()) return;
  // After the end of a truncated recording there is nothing to compare with.
  const bool is_beyond = next_ == run_.entries.size();
  if (is_beyond && !run_.damage.empty()) return;
  std::string what;
  if (is_beyond)
    what = "continues after the end of the recording";
  else if (run_.entries[next_].index() != entry.index())
    what = std::string("has ") + log::kTopics[entry.index()] + " where the recording has " +
           log::kTopics[run_.entries[next_].index()];
  else if (const std::string field = log::difference(run_.entries[next_], entry); !field.empty())
    what = std::string(log::kTopics[entry.index()]) + ": " + field;
  if (what.empty()) {
    ++next_;
    ++equal_;
    return;
  }
  departure_ = "tick " + std::to_string(ticks_) + " (" + seconds(timeOf(entry)) + "): " + what;
}

}  // namespace vps::device
