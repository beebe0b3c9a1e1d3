// SPDX-License-Identifier: BSD-3-Clause
// MCAP, the container that Foxglove and ROS 2 tools open: a small writer and a reader of our own.
// Source: the format's specification, https://mcap.dev/spec.
//
// Written files are chunked, not compressed, indexed, and carry every checksum that the format has, so that
// any changed byte is noticed.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps_device/crc32.h"
#include "vps_device/export.h"

namespace vps::device {

struct McapSchema {
  std::uint16_t id = 0;  ///< 1 and up
  std::string name, encoding, data;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic, encoding;
  std::map<std::string, std::string> metadata;
};

struct McapAttachment {
  std::string name, media_type, data;
};

struct McapMetadata {
  std::string name;
  std::map<std::string, std::string> values;
};

/// A message as read: `data` looks into the bytes that were read.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t time_ns = 0;  ///< log time
  std::string_view data;
};

/// Where reading stopped, or what was found wrong.
struct McapDamage {
  std::size_t at_byte = 0;
  std::string words;    ///< "ends in the middle of a record"; no file name
  bool is_cut = false;  ///< the file just ends; what is there reads well
};

struct McapContent {
  std::string profile, library;
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::vector<McapMessage> messages;  ///< in the file's order
  std::vector<McapAttachment> attachments;
  std::vector<McapMetadata> metadata;
  std::optional<McapDamage> damage;  ///< none: whole, and every checksum right
};

/// True for bytes that begin as every MCAP file does.
VPS_DEVICE_API bool isMcap(std::string_view bytes) noexcept;

/// Reads front to back and keeps all before the first damage. A chunk whose checksum is wrong is left out
/// whole, since nobody knows which of its bytes is wrong; of a chunk that the file's end cuts, the messages
/// that are there are kept. Compressed chunks are not read. Never throws (but std::bad_alloc); memory: ten
/// times the bytes at most, whatever lengths they claim. O(bytes).
VPS_DEVICE_API McapContent readMcap(std::string_view bytes);

/// Writes front to back; nothing is ever gone back to, so what is written stays good if the program dies.
class VPS_DEVICE_API McapWriter {
 public:
  using Sink = std::function<void(std::string_view)>;  ///< takes the next bytes; what it throws goes through

  /// A chunk ends when it holds so many bytes or spans so long: what a crash can lose.
  static constexpr std::size_t kChunkBytes = 64 * 1024;
  static constexpr std::uint64_t kChunkTime_ns = 250'000'000;

  McapWriter(Sink sink, const std::string& profile, const std::string& library);

  /// Returns the id. Add all before the first message that needs them.
  std::uint16_t addSchema(const std::string& name, const std::string& encoding, const std::string& data);
  std::uint16_t addChannel(McapChannel channel);
  void addAttachment(const McapAttachment& attachment);
  void addMetadata(const McapMetadata& metadata);

  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns, std::string_view data);
  /// Hands what is there to the sink as a chunk.
  void flush();
  /// Ends the file with its indexes. Nothing may follow.
  void finish();

 private:
  struct ChunkPlace {
    std::uint64_t first_ns, last_ns, at, length, index_length, bytes;
    std::map<std::uint16_t, std::uint64_t> index_at;
  };
  struct Indexed {
    std::uint64_t at, length;
    std::string name, media_type;
    std::uint64_t bytes;
  };

  void emit(std::string_view bytes);
  /// Writes a record; returns where it begins.
  std::uint64_t emitRecord(std::uint8_t opcode, const std::string& content);
  void emitGroup(std::uint8_t opcode, const std::vector<std::string>& contents, std::string& offsets);
  /// Returns the summary offset records.
  std::string emitSummary();
  [[nodiscard]] std::string statistics() const;
  static std::string chunkBytes(const ChunkPlace& chunk);
  static std::string attachmentBytes(const Indexed& file);
  static std::string metadataBytes(const Indexed& entry);

  Sink sink_;
  std::uint64_t at_ = 0;
  Crc32 crc_;  ///< of the data section, then of the summary
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<Indexed> attachments_, metadata_;
  std::vector<ChunkPlace> chunks_;
  std::string chunk_;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0, first_ns_ = 0, last_ns_ = 0;
  std::map<std::uint16_t, std::string> chunk_index_;  ///< entries, as they stand in the file
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint64_t message_count_ = 0;
};

}  // namespace vps::device
