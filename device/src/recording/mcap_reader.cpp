// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/detail/bytes.h"
#include "vps_device/detail/mcap.h"

namespace vps::device {

using namespace mcap;

namespace {

constexpr const char* kContradiction = "holds a record that contradicts its own length";

std::map<std::string, std::string> textMap(std::string_view bytes, bool& is_good) {
  std::map<std::string, std::string> map;
  ByteReader in(bytes);
  while (in.isGood() && in.left() > 0) {
    const std::string_view key = in.text(), value = in.text();
    if (in.isGood()) map.emplace(key, value);
  }
  is_good = is_good && in.isGood();
  return map;
}

/// One pass over the bytes. Offsets are from the start of the file.
class Parser {
 public:
  explicit Parser(std::string_view bytes) : bytes_(bytes) {}

  McapContent parse() {
    if (!isMcap(bytes_)) {
      const bool is_cut = kMagic.starts_with(bytes_);
      fail(0, is_cut ? "is shorter than the first bytes of an MCAP file" : "does not begin like an MCAP file",
           is_cut);
      return std::move(content_);
    }
    for (std::size_t at = kMagic.size(); !content_.damage && !is_over_;) at = record(at);
    return std::move(content_);
  }

 private:
  void fail(std::size_t at, std::string words, bool is_cut = false) {
    if (!content_.damage) content_.damage = McapDamage{at, std::move(words), is_cut};
  }

  /// Reads the record at `at`; returns where the next record begins.
  std::size_t record(std::size_t at) {
    ByteReader in(bytes_.substr(at));
    const auto opcode = in.get<std::uint8_t>();
    const auto length = in.get<std::uint64_t>();
    if (!in.isGood() || length > in.left()) {
      // A corrupt length looks like a truncated file. Messages that no checksum covers are therefore kept
      // only from a chunk at the end of the file.
      fail(at,
           in.left() == 0 && !in.isGood() ? "ends without its closing record"
                                          : "ends in the middle of a record",
           true);
      if (in.isGood() && opcode == kChunk) cutChunk(in.take(in.left()));
      return bytes_.size();
    }
    const std::string_view body = in.take(length);
    const std::size_t next = at + kRecordHead + body.size();
    if (opcode == kDataEnd) {
      dataEnd(at, body);
      if (!content_.damage) summary(next);
      is_over_ = true;
    } else if (opcode == kFooter) {
      summary(at);
      is_over_ = true;
    } else if (opcode == kChunk) {
      chunk(at, body);
    } else {
      plain(at, opcode, body);
    }
    return next;
  }

  void plain(std::size_t at, std::uint8_t opcode, std::string_view body) {
    ByteReader in(body);
    bool is_good = true;
    if (opcode == kMessage) return message(at, body);
    if (opcode == kAttachment) return attachment(at, body);
    if (opcode == 0) return fail(at, "holds zeros where a record should begin");
    if (opcode == kHeader) {
      content_.profile = in.text();
      content_.library = in.text();
    } else if (opcode == kSchema) {
      schema(in);
    } else if (opcode == kChannel) {
      is_good = channel(in);
    } else if (opcode == kMetadata) {
      is_good = metadata(in);
    }  // else: an index, which a sequential reader does not need, or a record of a later version
    if (!in.isGood() || !is_good) fail(at, kContradiction);
  }

  void schema(ByteReader& in) {
    McapSchema schema;
    schema.id = in.get<std::uint16_t>();
    schema.name = in.text();
    schema.encoding = in.text();
    schema.data = in.text();
    if (in.isGood()) content_.schemas.emplace(schema.id, std::move(schema));
  }

  bool channel(ByteReader& in) {
    McapChannel channel;
    bool is_good = true;
    channel.id = in.get<std::uint16_t>();
    channel.schema = in.get<std::uint16_t>();
    channel.topic = in.text();
    channel.encoding = in.text();
    channel.metadata = textMap(in.text(), is_good);
    is_good = is_good && in.isGood();
    if (is_good) content_.channels.emplace(channel.id, std::move(channel));
    return is_good;
  }

  bool metadata(ByteReader& in) {
    McapMetadata metadata;
    bool is_good = true;
    metadata.name = in.text();
    metadata.values = textMap(in.text(), is_good);
    is_good = is_good && in.isGood();
    if (is_good) content_.metadata.push_back(std::move(metadata));
    return is_good;
  }

  void message(std::size_t at, std::string_view body) {
    ByteReader in(body);
    McapMessage message;
    message.channel = in.get<std::uint16_t>();
    message.sequence = in.get<std::uint32_t>();
    message.time_ns = in.get<std::uint64_t>();
    in.get<std::uint64_t>();
    message.data = in.take(in.left());
    if (!in.isGood()) return fail(at, kContradiction);
    if (!content_.channels.contains(message.channel)) return fail(at, "holds a message of no known channel");
    content_.messages.push_back(message);
  }

  void attachment(std::size_t at, std::string_view body) {
    ByteReader in(body);
    in.get<std::uint64_t>();
    in.get<std::uint64_t>();
    const std::string_view name = in.text(), media_type = in.text(), data = in.text<std::uint64_t>();
    const std::string_view summed = body.substr(0, body.size() - in.left());
    const auto crc = in.get<std::uint32_t>();
    if (!in.isGood()) return fail(at, kContradiction);
    if (crc != 0 && crc != crc32(summed))
      return fail(at, "has an attachment whose checksum is wrong: '" + std::string(name) + "'");
    content_.attachments.push_back({std::string(name), std::string(media_type), std::string(data)});
  }

  void chunk(std::size_t at, std::string_view body) {
    ByteReader in(body);
    in.get<std::uint64_t>();
    in.get<std::uint64_t>();
    const auto bytes = in.get<std::uint64_t>();
    const auto crc = in.get<std::uint32_t>();
    const std::string_view compression = in.text(), records = in.text<std::uint64_t>();
    if (!in.isGood()) return fail(at, kContradiction);
    if (!compression.empty())
      return fail(at, "has a chunk compressed by '" + std::string(compression) +
                          "', which this program cannot decompress");
    if (bytes != records.size() || (crc != 0 && crc != crc32(records)))
      return fail(at, "has a chunk whose checksum is wrong");
    inside(static_cast<std::size_t>(records.data() - bytes_.data()), records);
  }

  /// Reads the complete messages of a chunk that the end of the file truncates; its checksum cannot be
  /// verified.
  void cutChunk(std::string_view body) {
    ByteReader in(body);
    in.take(8 + 8 + 8 + 4);
    const std::string_view compression = in.text();
    in.get<std::uint64_t>();
    if (!in.isGood() || !compression.empty()) return;
    const std::string_view records = in.take(in.left());
    inside(static_cast<std::size_t>(records.data() - bytes_.data()), records);
  }

  /// Reads the records of a chunk, which begin at `at`.
  void inside(std::size_t at, std::string_view records) {
    ByteReader in(records);
    const bool was_cut = content_.damage.has_value();
    while (in.left() > 0) {
      const std::size_t begin = at + (records.size() - in.left());
      const auto opcode = in.get<std::uint8_t>();
      const std::string_view body = in.text<std::uint64_t>();
      if (!in.isGood()) return fail(begin, kContradiction);
      if (opcode != kMessage && opcode != kSchema && opcode != kChannel)
        return fail(begin, "has a chunk with a record that does not belong in a chunk");
      plain(begin, opcode, body);
      if (content_.damage && !was_cut) return;
    }
  }

  void dataEnd(std::size_t at, std::string_view body) {
    ByteReader in(body);
    const auto crc = in.get<std::uint32_t>();
    if (!in.isGood()) return fail(at, kContradiction);
    if (crc != 0 && crc != crc32(bytes_.substr(0, at)))
      fail(at, "has a changed byte outside of its messages");
  }

  /// Reads from the summary to the end of the file. Only the checksum is verified; the content is not needed.
  void summary(std::size_t at) {
    constexpr std::size_t kEnd = kRecordHead + kFooterBytes;
    const std::string_view rest = bytes_.substr(at);
    if (rest.size() < kEnd + kMagic.size() || !rest.ends_with(kMagic))
      return fail(at, "has all its messages, but lacks the end of its index", true);
    const std::size_t footer_at = rest.size() - kMagic.size() - kEnd;
    ByteReader in(rest.substr(footer_at));
    const bool is_footer = in.get<std::uint8_t>() == kFooter && in.get<std::uint64_t>() == kFooterBytes;
    in.take(16);
    const auto crc = in.get<std::uint32_t>();
    const std::string_view summed = rest.substr(0, footer_at + kEnd - sizeof crc);
    if (!is_footer || (crc != 0 && crc != crc32(summed)))
      fail(at, "has all its messages, but a damaged index");
  }

  std::string_view bytes_;
  McapContent content_;
  bool is_over_ = false;
};

}  // namespace

bool isMcap(std::string_view bytes) noexcept {
  return bytes.starts_with(kMagic);
}

McapContent readMcap(std::string_view bytes) {
  return Parser(bytes).parse();
}

}  // namespace vps::device
