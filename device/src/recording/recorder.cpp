// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/recording.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "recording/log_fields.h"
#include "recording/recording_format.h"
#include "vps/errors.h"
#include "vps_device/detail/bytes.h"
#include "vps_device/detail/entry_ring.h"

namespace vps::device {

namespace {

namespace fs = std::filesystem;

constexpr auto kPoll = std::chrono::milliseconds(5);

/// The file at the end of symbolic links, since a rename onto a link would replace the link.
fs::path target(const std::string& file) {
  fs::path path = file;
  std::error_code error;
  for (int links = 0; links < 40 && fs::is_symlink(path, error); ++links)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

/// Throws LoadError unless the path is free, an empty file, or a recording of this program.
void requireRecordingOrNothing(const fs::path& path, const std::string& file) {
  std::error_code error;
  if (!fs::exists(path, error)) return;
  if (!fs::is_regular_file(path, error))
    throw LoadError(file, "", "is not a regular file; name another file for the recording");
  // The first bytes suffice: magic, and the record with profile and library.
  std::array<char, 256> bytes{};
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), static_cast<std::size_t>(in.gcount()));
  if (in.gcount() > 0 && !readMcap(head).library.starts_with(recording::kLibrary))
    throw LoadError(file, "",
                    "exists and is not a recording of this program; name another file for the recording");
}

/// An unbuffered file, so that written bytes survive a crash of this program.
class PlainFile {
 public:
  explicit PlainFile(const std::string& file) : file_(std::fopen(file.c_str(), "wbx")) {
    if (file_ != nullptr) std::setvbuf(file_, nullptr, _IONBF, 0);
  }
  ~PlainFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  PlainFile(const PlainFile&) = delete;
  PlainFile& operator=(const PlainFile&) = delete;
  [[nodiscard]] bool isOpen() const { return file_ != nullptr; }
  bool write(std::string_view bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size();
  }
  bool close() {
    const bool is_good = std::fclose(file_) == 0;
    file_ = nullptr;
    return is_good;
  }

 private:
  std::FILE* file_;
};

/// Simulated seconds as the format's nanoseconds; an invalid time repeats the last one.
std::uint64_t nanoseconds(double time_s, std::uint64_t last_ns) {
  constexpr double kLongest_s = 1e9;
  return time_s >= 0 && time_s < kLongest_s ? static_cast<std::uint64_t>(time_s * 1e9 + 0.5) : last_ns;
}

/// Schemas of standard ROS messages, with which ROS tools and Foxglove show part and force without
/// configuration.
constexpr const char* kHeaderSchema =
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
constexpr const char* kVectorSchema =
    "================================================================================\n"
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";

std::string poseSchema() {
  const std::string line(80, '=');
  return "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + std::string(kHeaderSchema) + line +
         "\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n" +
         line + "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + line +
         "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
}

std::string wrenchSchema() {
  const std::string line(80, '=');
  return "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n" + std::string(kHeaderSchema) + line +
         "\nMSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n" +
         kVectorSchema;
}

/// A stamped message in CDR: stamp, frame "world", then doubles.
template <std::size_t N>
std::string stamped(std::uint64_t time_ns, const std::array<double, N>& values) {
  std::string out("\0\1\0\0", 4);
  ByteWriter w(out);
  w.put(static_cast<std::uint32_t>(time_ns / 1'000'000'000));
  w.put(static_cast<std::uint32_t>(time_ns % 1'000'000'000));
  w.text(std::string_view("world\0", 6));
  while ((out.size() - 4) % 8 != 0) out.push_back(0);
  for (const double value : values) w.put(value);
  return out;
}

}  // namespace

struct Recorder::Work {
  Work(const std::string& name, const RecordingHead& head, std::size_t entries)
      : final_path(target(name)),
        partial(final_path.string() + "." + std::to_string(getpid()) + ".unfinished"),
        out(open(name)),
        ring(entries),
        writer([this](std::string_view bytes) { write(bytes); }, recording::kProfile, recording::kLibrary) {
    for (std::size_t kind = 0; kind < log::kKinds; ++kind)
      channels[kind] = addChannel(log::kTypes[kind], log::schema(kind), log::kTopics[kind]);
    pose_channel = addChannel("geometry_msgs/msg/PoseStamped", poseSchema(), "/run/part_pose");
    wrench_channel = addChannel("geometry_msgs/msg/WrenchStamped", wrenchSchema(), "/run/hand_wrench");
    writeHead(head);
    if (!error.empty()) {
      std::error_code ignored;
      fs::remove(partial, ignored);
      throw LoadError(name, "", error);
    }
    thread = std::thread([this] { work(); });
  }

  std::unique_ptr<PlainFile> open(const std::string& name) {
    requireRecordingOrNothing(final_path, name);
    auto file = std::make_unique<PlainFile>(partial);
    if (!file->isOpen())
      throw LoadError(name, "",
                      std::string("cannot be written: ") + std::strerror(errno) + "; choose another place");
    return file;
  }

  std::uint16_t addChannel(const std::string& type, const std::string& schema, const std::string& topic) {
    const std::uint16_t id = writer.addSchema(type, "ros2msg", schema);
    return writer.addChannel({0, id, topic, "cdr", {{"offered_qos_profiles", ""}}});
  }

  void writeHead(const RecordingHead& head) {
    auto about = head.about;
    about["format"] = recording::kFormat;
    writer.addMetadata({recording::kAbout, about});
    std::map<std::string, std::string> device = {{"name", head.device}};
    recording::eachLimit(head.limits,
                         [&](const std::string& name, double x) { device[name] = log::number(x); });
    writer.addMetadata({recording::kDevice, device});
    for (const McapAttachment& attachment : head.attachments) writer.addAttachment(attachment);
  }

  void write(std::string_view bytes) {
    errno = 0;
    if (error.empty() && !out->write(bytes))
      error = std::string("cannot be written: ") + std::strerror(errno);
  }

  void work() {
    // The flag is read before the ring, so that all entries added before the flag was set are written.
    for (bool is_last = false; !is_last;) {
      is_last = is_ending.load(std::memory_order_acquire);
      while (const EntryRing::Slot* slot = ring.front()) {
        writeEntry(*slot);
        ring.pop();
      }
      if (!is_last) std::this_thread::sleep_for(kPoll);
    }
  }

  void writeEntry(const EntryRing::Slot& slot) {
    time_ns = nanoseconds(timeOf(slot.entry), time_ns);
    has_read = has_read || std::holds_alternative<DeviceSample>(slot.entry);
    writer.write(channels[slot.entry.index()], slot.number, time_ns, log::encoded(slot.entry));
    const auto* trace = std::get_if<RunTrace>(&slot.entry);
    if (trace == nullptr) return;
    const Vec3& p = trace->X_WP.p;
    const Quat q = trace->X_WP.quaternion();
    const Wrench& F = trace->F_hand_W;
    writer.write(pose_channel, slot.number, time_ns,
                 stamped<7>(time_ns, {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}));
    writer.write(wrench_channel, slot.number, time_ns,
                 stamped<6>(time_ns, {F.f.x(), F.f.y(), F.f.z(), F.tau.x(), F.tau.y(), F.tau.z()}));
  }

  void stop() {
    is_ending.store(true, std::memory_order_release);
    if (thread.joinable()) thread.join();
  }

  fs::path final_path;
  std::string partial;
  std::string error;
  std::unique_ptr<PlainFile> out;
  EntryRing ring;
  McapWriter writer;
  std::array<std::uint16_t, log::kKinds> channels{};
  std::uint16_t pose_channel = 0, wrench_channel = 0;
  std::uint64_t time_ns = 0;
  bool has_read = false, is_finished = false;
  std::atomic<bool> is_ending{false};
  std::thread thread;
  std::uint32_t number = 0;  ///< number of the next entry; dropped entries are numbered too
  std::atomic<std::uint64_t> dropped{0};
};

Recorder::Recorder(const std::string& file, const RecordingHead& head, std::size_t ring_entries)
    : work_(std::make_unique<Work>(file, head, ring_entries)) {}

Recorder::~Recorder() {
  work_->stop();
  if (work_->is_finished) return;
  if (work_->has_read) {
    work_->writer.flush();
    return;
  }
  std::error_code ignored;
  fs::remove(work_->partial, ignored);
}

void Recorder::add(const LogEntry& entry) noexcept {
  Work& w = *work_;
  if (!w.ring.push(w.number++, entry)) w.dropped.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::lose(std::uint64_t count) noexcept {
  work_->number += static_cast<std::uint32_t>(count);
  work_->dropped.fetch_add(count, std::memory_order_relaxed);
}

void Recorder::waitForRoom() const {
  while (work_->ring.isHalfFull()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void Recorder::finish() {
  Work& w = *work_;
  w.stop();
  w.writer.flush();
  w.writer.addMetadata(
      {recording::kEnd, {{"entries", std::to_string(w.number)}, {"dropped", std::to_string(dropped())}}});
  w.writer.finish();
  if (w.error.empty() && !w.out->close()) w.error = std::string("cannot be written: ") + std::strerror(errno);
  if (!w.error.empty())
    throw std::runtime_error(w.final_path.string() + ": " + w.error + "; the unfinished recording is in " +
                             w.partial);
  std::error_code error;
  fs::rename(w.partial, w.final_path, error);
  if (error)
    throw std::runtime_error(w.final_path.string() + ": cannot be written: " + error.message() +
                             "; the recording is in " + w.partial);
  w.is_finished = true;
}

std::uint64_t Recorder::dropped() const noexcept {
  return work_->dropped.load(std::memory_order_relaxed);
}

const std::string& Recorder::unfinished() const noexcept {
  return work_->partial;
}

}  // namespace vps::device
