// SPDX-License-Identifier: BSD-3-Clause
// Binary files that end with a hash of their content. Numbers are stored as in memory.
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "vps/mesh.h"

namespace vps {

using Digest = std::array<std::uint64_t, 2>;

/// More bytes than a file has; keeps sums of sizes from a damaged header within 64 bits.
inline constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 60;

/// The first bytes of every file.
struct CacheFileStart {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t byte_order = 0x01020304;  ///< reads as another number on a machine of the other byte order
  Digest key = {};

  [[nodiscard]] bool isOfSameVersion(const CacheFileStart& other) const {
    return version == other.version && byte_order == other.byte_order;
  }
};

class Hash {
 public:
  Hash() { XXH3_128bits_reset(&state_); }
  void add(const void* bytes, std::size_t count) { XXH3_128bits_update(&state_, bytes, count); }
  void add(const Mesh& mesh) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    add(mesh.vertices.data(), mesh.vertices.size() * sizeof mesh.vertices[0]);
    add(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  }
  [[nodiscard]] Digest digest() const {
    const XXH128_hash_t h = XXH3_128bits_digest(&state_);
    return {h.high64, h.low64};
  }

 private:
  XXH3_state_t state_;
};

/// The digest in hexadecimal, used as a file's name without extension.
inline std::string nameOf(const Digest& key) {
  std::array<char, 33> text;
  std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(key[0]),
                static_cast<unsigned long long>(key[1]));
  return text.data();
}

/// Reads a file and hashes what it reads; isGood() becomes false at the first missing byte.
class HashedReader {
 public:
  explicit HashedReader(const std::filesystem::path& file) : in_(file, std::ios::binary) {}
  [[nodiscard]] bool isGood() const { return in_.good(); }
  void read(void* to, std::size_t bytes) {
    in_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
    if (in_.good()) hash_.add(to, bytes);
  }
  template <typename T>
  void read(std::vector<T>& to) {
    read(to.data(), to.size() * sizeof(T));
  }
  /// True if the file ends with the hash of all that was read.
  [[nodiscard]] bool endsWell() {
    const Digest found = hash_.digest();
    Digest kept = {};
    in_.read(reinterpret_cast<char*>(kept.data()), sizeof kept);
    return in_.good() && found == kept && in_.peek() == std::ifstream::traits_type::eof();
  }

 private:
  std::ifstream in_;
  Hash hash_;
};

/// Reads the header of a file. Returns nothing, and a reason in `why`, unless the file is of this kind and
/// version, was made from the data of `key`, and has the size that bytesOf(header) tells; the size is tested
/// before memory is allocated for the rest.
/// @param not_this_kind  the reason if the file is of another kind, such as "is not a voxmap"
template <class Header, class BytesOf>
std::optional<Header> readHeader(HashedReader& reader, const std::filesystem::path& file, const Digest& key,
                                 const char* not_this_kind, BytesOf bytesOf, std::string& why) {
  Header header;
  if (!reader.isGood()) return why = "cannot be read", std::nullopt;
  const CacheFileStart expected = header.start;
  reader.read(&header, sizeof header);
  if (!reader.isGood() || header.start.magic != expected.magic) return why = not_this_kind, std::nullopt;
  if (!header.start.isOfSameVersion(expected))
    return why = "was written by another version of this program", std::nullopt;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  const std::optional<std::uint64_t> bytes = bytesOf(header);
  if (error || !bytes || *bytes != size) return why = "is damaged or cut short", std::nullopt;
  if (header.start.key != key) return why = "was made from other data", std::nullopt;
  return header;
}

class HashedWriter {
 public:
  explicit HashedWriter(const std::filesystem::path& file) : out_(file, std::ios::binary) {}
  void write(const void* from, std::size_t bytes) {
    out_.write(static_cast<const char*>(from), static_cast<std::streamsize>(bytes));
    hash_.add(from, bytes);
  }
  template <typename T>
  void write(const std::vector<T>& from) {
    write(from.data(), from.size() * sizeof(T));
  }
  /// True if everything has been written.
  bool finish() {
    const Digest digest = hash_.digest();
    out_.write(reinterpret_cast<const char*>(digest.data()), sizeof digest);
    out_.close();
    return !out_.fail();
  }

 private:
  std::ofstream out_;
  Hash hash_;
};

}  // namespace vps
