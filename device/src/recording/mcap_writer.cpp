// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "vps_device/detail/bytes.h"
#include "vps_device/detail/mcap.h"

namespace vps::device {

using namespace mcap;

namespace {

template <typename Put>
std::string built(const Put& put) {
  std::string out;
  ByteWriter writer(out);
  put(writer);
  return out;
}

std::string mapBytes(const std::map<std::string, std::string>& map) {
  return built([&](ByteWriter& w) {
    for (const auto& [key, value] : map) {
      w.text(key);
      w.text(value);
    }
  });
}

std::string mapBytes(const std::map<std::uint16_t, std::uint64_t>& map) {
  return built([&](ByteWriter& w) {
    for (const auto& [key, value] : map) {
      w.put(key);
      w.put(value);
    }
  });
}

std::string schemaBytes(const McapSchema& schema) {
  return built([&](ByteWriter& w) {
    w.put(schema.id);
    w.text(schema.name);
    w.text(schema.encoding);
    w.text(schema.data);
  });
}

std::string channelBytes(const McapChannel& channel) {
  return built([&](ByteWriter& w) {
    w.put(channel.id);
    w.put(channel.schema);
    w.text(channel.topic);
    w.text(channel.encoding);
    w.text(mapBytes(channel.metadata));
  });
}

template <typename T, typename Bytes>
std::vector<std::string> each(const std::vector<T>& list, const Bytes& bytes) {
  std::vector<std::string> out;
  for (const T& x : list) out.push_back(bytes(x));
  return out;
}

}  // namespace

McapWriter::McapWriter(Sink sink, const std::string& profile, const std::string& library)
    : sink_(std::move(sink)) {
  emit(kMagic);
  emitRecord(kHeader, built([&](ByteWriter& w) {
               w.text(profile);
               w.text(library);
             }));
}

void McapWriter::emit(std::string_view bytes) {
  crc_ = crc32(bytes, crc_);
  at_ += bytes.size();
  sink_(bytes);
}

std::uint64_t McapWriter::emitRecord(std::uint8_t opcode, const std::string& content) {
  const std::uint64_t begin = at_;
  // One call per record, so that an unbuffered sink writes whole records.
  emit(built([&](ByteWriter& w) {
    w.put(opcode);
    w.text<std::uint64_t>(content);
  }));
  return begin;
}

std::uint16_t McapWriter::addSchema(const std::string& name, const std::string& encoding,
                                    const std::string& data) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back({id, name, encoding, data});
  emitRecord(kSchema, schemaBytes(schemas_.back()));
  return id;
}

std::uint16_t McapWriter::addChannel(McapChannel channel) {
  channel.id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_.push_back(std::move(channel));
  emitRecord(kChannel, channelBytes(channels_.back()));
  return channels_.back().id;
}

void McapWriter::addAttachment(const McapAttachment& attachment) {
  flush();
  std::string content = built([&](ByteWriter& w) {
    w.put(std::uint64_t{0});  // times of recording and creation are zero, so that files repeat byte for byte
    w.put(std::uint64_t{0});
    w.text(attachment.name);
    w.text(attachment.media_type);
    w.text<std::uint64_t>(attachment.data);
  });
  const std::uint32_t crc = crc32(content);
  ByteWriter(content).put(crc);
  const std::uint64_t at = emitRecord(kAttachment, content);
  attachments_.push_back({at, at_ - at, attachment.name, attachment.media_type, attachment.data.size()});
}

void McapWriter::addMetadata(const McapMetadata& metadata) {
  flush();
  const std::uint64_t at = emitRecord(kMetadata, built([&](ByteWriter& w) {
                                        w.text(metadata.name);
                                        w.text(mapBytes(metadata.values));
                                      }));
  metadata_.push_back({at, at_ - at, metadata.name, "", 0});
}

void McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                       std::string_view data) {
  const bool is_first = chunk_.empty();
  if (!is_first &&
      (chunk_.size() + data.size() > kChunkBytes || time_ns >= chunk_first_ns_ + kChunkTime_ns)) {
    flush();
    return write(channel, sequence, time_ns, data);
  }
  chunk_first_ns_ = is_first ? time_ns : std::min(chunk_first_ns_, time_ns);
  chunk_last_ns_ = is_first ? time_ns : std::max(chunk_last_ns_, time_ns);
  first_ns_ = message_count_ == 0 ? time_ns : std::min(first_ns_, time_ns);
  last_ns_ = std::max(last_ns_, time_ns);
  ByteWriter index(chunk_index_[channel]);
  index.put(time_ns);
  index.put(std::uint64_t{chunk_.size()});
  ByteWriter w(chunk_);
  w.put(kMessage);
  w.put(std::uint64_t{2 + 4 + 8 + 8 + data.size()});
  w.put(channel);
  w.put(sequence);
  w.put(time_ns);  // time of logging
  w.put(time_ns);  // time of publishing
  w.bytes(data);
  ++counts_[channel];
  ++message_count_;
}

void McapWriter::flush() {
  if (chunk_.empty()) return;
  ChunkPlace place{chunk_first_ns_, chunk_last_ns_, 0, 0, 0, chunk_.size(), {}};
  place.at = emitRecord(kChunk, built([&](ByteWriter& w) {
                          w.put(chunk_first_ns_);
                          w.put(chunk_last_ns_);
                          w.put(std::uint64_t{chunk_.size()});
                          w.put(crc32(chunk_));
                          w.text("");
                          w.text<std::uint64_t>(chunk_);
                        }));
  place.length = at_ - place.at;
  for (const auto& index : chunk_index_)
    place.index_at[index.first] = emitRecord(kMessageIndex, built([&](ByteWriter& w) {
                                               w.put(index.first);
                                               w.text(index.second);
                                             }));
  place.index_length = at_ - place.at - place.length;
  chunks_.push_back(std::move(place));
  chunk_.clear();
  chunk_index_.clear();
}

void McapWriter::emitGroup(std::uint8_t opcode, const std::vector<std::string>& contents,
                           std::string& offsets) {
  if (contents.empty()) return;
  const std::uint64_t begin = at_;
  for (const std::string& content : contents) emitRecord(opcode, content);
  ByteWriter w(offsets);
  w.put(kSummaryOffset);
  w.put(std::uint64_t{1 + 8 + 8});
  w.put(opcode);
  w.put(begin);
  w.put(at_ - begin);
}

std::string McapWriter::statistics() const {
  return built([&](ByteWriter& w) {
    w.put(message_count_);
    w.put(static_cast<std::uint16_t>(schemas_.size()));
    for (const std::size_t count : {channels_.size(), attachments_.size(), metadata_.size(), chunks_.size()})
      w.put(static_cast<std::uint32_t>(count));
    w.put(first_ns_);
    w.put(last_ns_);
    w.text(mapBytes(counts_));
  });
}

void McapWriter::finish() {
  flush();
  const std::uint32_t data_crc = crc_;
  emitRecord(kDataEnd, built([&](ByteWriter& w) { w.put(data_crc); }));
  crc_ = 0;
  const std::uint64_t summary_at = at_;
  const std::string offsets = emitSummary();
  const std::uint64_t offsets_at = at_;
  emit(offsets);
  // The checksum covers the footer up to itself.
  emit(built([&](ByteWriter& w) {
    w.put(kFooter);
    w.put(std::uint64_t{kFooterBytes});
    w.put(summary_at);
    w.put(offsets_at);
  }));
  const std::uint32_t summary_crc = crc_;
  emit(built([&](ByteWriter& w) { w.put(summary_crc); }));
  emit(kMagic);
}

std::string McapWriter::emitSummary() {
  std::string offsets;
  emitGroup(kSchema, each(schemas_, schemaBytes), offsets);
  emitGroup(kChannel, each(channels_, channelBytes), offsets);
  emitGroup(kChunkIndex, each(chunks_, &McapWriter::chunkBytes), offsets);
  emitGroup(kAttachmentIndex, each(attachments_, &McapWriter::attachmentBytes), offsets);
  emitGroup(kMetadataIndex, each(metadata_, &McapWriter::metadataBytes), offsets);
  emitGroup(kStatistics, {statistics()}, offsets);
  return offsets;
}

std::string McapWriter::chunkBytes(const ChunkPlace& chunk) {
  return built([&](ByteWriter& w) {
    for (const std::uint64_t value : {chunk.first_ns, chunk.last_ns, chunk.at, chunk.length}) w.put(value);
    w.text(mapBytes(chunk.index_at));
    w.put(chunk.index_length);
    w.text("");  // name of the compression: none, so both sizes are equal
    w.put(chunk.bytes);
    w.put(chunk.bytes);
  });
}

std::string McapWriter::attachmentBytes(const Indexed& file) {
  return built([&](ByteWriter& w) {
    for (const std::uint64_t value : {file.at, file.length, std::uint64_t{0}, std::uint64_t{0}, file.bytes})
      w.put(value);
    w.text(file.name);
    w.text(file.media_type);
  });
}

std::string McapWriter::metadataBytes(const Indexed& entry) {
  return built([&](ByteWriter& w) {
    w.put(entry.at);
    w.put(entry.length);
    w.text(entry.name);
  });
}

}  // namespace vps::device
