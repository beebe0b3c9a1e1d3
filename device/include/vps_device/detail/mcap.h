// SPDX-License-Identifier: BSD-3-Clause
// Writer and reader of MCAP, the container format that Foxglove and ROS 2 tools open.
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

#include "vps_device/export.h"

namespace vps::device {

namespace mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

inline constexpr std::uint8_t kHeader = 1, kFooter = 2, kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6,
                              kMessageIndex = 7, kChunkIndex = 8, kAttachment = 9, kAttachmentIndex = 10,
                              kStatistics = 11, kMetadata = 12, kMetadataIndex = 13, kSummaryOffset = 14,
                              kDataEnd = 15;

/// Opcode and length before every record.
inline constexpr std::size_t kRecordHead = 9;
inline constexpr std::size_t kFooterBytes = 20;

}  // namespace mcap

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

/// A message as read: `data` is a view into the bytes that were read.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t time_ns = 0;  ///< log time
  std::string_view data;
};

/// Place and cause of damage in a file.
struct McapDamage {
  std::size_t at_byte = 0;
  std::string words;    ///< "ends in the middle of a record", without the file name
  bool is_cut = false;  ///< the file is truncated, and not damaged before its end
};

struct McapContent {
  std::string profile, library;
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::vector<McapMessage> messages;  ///< messages in the order of the file
  std::vector<McapAttachment> attachments;
  std::vector<McapMetadata> metadata;
  std::optional<McapDamage> damage;  ///< empty: the file is complete, and every checksum is right
};

/// True for bytes that begin with the magic of MCAP.
VPS_DEVICE_API bool isMcap(std::string_view bytes) noexcept;

/// Reads front to back and keeps everything before the first damage. A chunk with a wrong checksum is left
/// out whole, since any of its bytes may be wrong; of a chunk that the file's end cuts, the complete messages
/// are kept. Compressed chunks are not read. Throws nothing but std::bad_alloc. Memory: at most ten times the
/// bytes, whatever lengths they claim. O(bytes).
VPS_DEVICE_API McapContent readMcap(std::string_view bytes);

/// Writes front to back and never seeks, so that what is written stays valid if the program ends abruptly.
class VPS_DEVICE_API McapWriter {
 public:
  using Sink = std::function<void(std::string_view)>;  ///< takes the next bytes; its exceptions propagate

  /// A chunk ends at this size or duration; a crash can lose one chunk.
  static constexpr std::size_t kChunkBytes = 64 * 1024;
  static constexpr std::uint64_t kChunkTime_ns = 250'000'000;

  McapWriter(Sink sink, const std::string& profile, const std::string& library);

  /// Adds a schema or a channel and returns its id. Add schemas and channels before the first message that
  /// needs them.
  std::uint16_t addSchema(const std::string& name, const std::string& encoding, const std::string& data);
  std::uint16_t addChannel(McapChannel channel);
  void addAttachment(const McapAttachment& attachment);
  void addMetadata(const McapMetadata& metadata);

  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns, std::string_view data);
  /// Passes the buffered messages to the sink as a chunk.
  void flush();
  /// Ends the file with its indexes. Nothing may be written afterwards.
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
  std::uint32_t crc_ = 0;  ///< checksum of the data section, then of the summary
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<Indexed> attachments_, metadata_;
  std::vector<ChunkPlace> chunks_;
  std::string chunk_;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0, first_ns_ = 0, last_ns_ = 0;
  std::map<std::uint16_t, std::string> chunk_index_;  ///< entries as written to the file
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint64_t message_count_ = 0;
};

}  // namespace vps::device
