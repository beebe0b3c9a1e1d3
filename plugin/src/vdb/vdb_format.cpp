// SPDX-License-Identifier: BSD-3-Clause
#include "vdb/vdb_format.h"

#include <mutex>

#include "vps/errors.h"

namespace vps {
namespace {

constexpr std::string_view kMark = "vps-end1";
constexpr std::size_t kEndBytes = kMark.size() + sizeof(std::uint64_t);

/// FNV-1a, 64 bit.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return sum;
}

}  // namespace

void refuseVdb(const std::string& file, const std::string& found_and_remedy) {
  throw LoadError(file, "", found_and_remedy);
}

void initializeOpenVdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

std::string endOf(std::string_view bytes) {
  std::string end(kMark);
  const std::uint64_t sum = checksum(bytes);
  for (int i = 0; i < 8; ++i) end.push_back(static_cast<char>(sum >> 8 * i & 0xff));
  return end;
}

Origin originOf(std::string_view bytes) {
  if (bytes.size() > kEndBytes &&
      bytes.substr(bytes.size() - kEndBytes) == endOf(bytes.substr(0, bytes.size() - kEndBytes)))
    return Origin::Ours;
  const bool has_traces =
      bytes.find("vps_parts") != std::string_view::npos || bytes.find(kMark) != std::string_view::npos;
  return has_traces ? Origin::Changed : Origin::Others;
}

}  // namespace vps
