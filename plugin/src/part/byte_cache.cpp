// SPDX-License-Identifier: BSD-3-Clause
// A file of a ByteCache has a BytesHeader, the bytes, and a hash of everything before it.
#include "vps/byte_cache.h"

#include <algorithm>

#include "part/cache_file.h"
#include "part/cache_folder.h"

namespace vps {
namespace {

namespace fs = std::filesystem;

/// Incremented when the file's layout changes.
constexpr std::uint32_t kBytesVersion = 1;
constexpr std::array<char, 8> kBytesMagic = {'v', 'p', 's', 'b', 'y', 't', 'e', 's'};
constexpr const char* kBytesEnding = ".bytes";

struct BytesHeader {
  CacheFileStart start = {kBytesMagic, kBytesVersion};
  std::uint64_t bytes = 0;
};
static_assert(std::is_trivially_copyable_v<BytesHeader> && sizeof(BytesHeader) == 40);  // no gaps

Digest bytesKeyOf(std::string_view made_from) {
  Hash hash;
  hash.add(kBytesMagic.data(), kBytesMagic.size());
  hash.add(made_from.data(), made_from.size());
  return hash.digest();
}

/// Returns nothing, and a reason in `why`, if the file cannot be trusted.
std::optional<std::string> readBytes(const fs::path& file, const Digest& key, std::string& why) {
  HashedReader reader(file);
  const auto header = readHeader<BytesHeader>(
      reader, file, key, "is not a file of this cache",
      [](const BytesHeader& h) {
        return sizeof(BytesHeader) + std::min(h.bytes, kMostBytes) + sizeof(Digest);
      },
      why);
  if (!header) return std::nullopt;
  std::string bytes(header->bytes, '\0');
  reader.read(bytes.data(), bytes.size());
  if (!reader.isGood() || !reader.endsWell()) return why = "is damaged", std::nullopt;
  return bytes;
}

}  // namespace

ByteCache::ByteCache(fs::path folder, Warn warn, std::uint64_t limit_bytes)
    : folder_(std::make_shared<CacheFolder>(std::move(folder), std::move(warn), limit_bytes)) {}

fs::path ByteCache::fileOf(std::string_view made_from) const {
  return folder_->fileOf(nameOf(bytesKeyOf(made_from)) + kBytesEnding);
}

std::optional<std::string> ByteCache::find(std::string_view made_from) const {
  const Digest key = bytesKeyOf(made_from);
  const fs::path file = folder_->fileOf(nameOf(key) + kBytesEnding);
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  std::string why;
  std::optional<std::string> bytes = readBytes(file, key, why);
  if (bytes)
    CacheFolder::touch(file);
  else
    folder_->warn(file, why + "; the result is computed again");
  return bytes;
}

void ByteCache::keep(std::string_view made_from, std::string_view bytes) const {
  const Digest key = bytesKeyOf(made_from);
  folder_->keep(folder_->fileOf(nameOf(key) + kBytesEnding), [&](const fs::path& to) {
    BytesHeader header;
    header.start.key = key;
    header.bytes = bytes.size();
    HashedWriter writer(to);
    writer.write(&header, sizeof header);
    writer.write(bytes.data(), bytes.size());
    return writer.finish();
  });
}

}  // namespace vps
