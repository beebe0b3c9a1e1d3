// SPDX-License-Identifier: BSD-3-Clause
// Constants of the MCAP format, for writer and reader.
#pragma once

#include <cstdint>
#include <string_view>

namespace vps::device::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

inline constexpr std::uint8_t kHeader = 1, kFooter = 2, kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6,
                              kMessageIndex = 7, kChunkIndex = 8, kAttachment = 9, kAttachmentIndex = 10,
                              kStatistics = 11, kMetadata = 12, kMetadataIndex = 13, kSummaryOffset = 14,
                              kDataEnd = 15;

/// Opcode and length before every record.
inline constexpr std::size_t kRecordHead = 9;
inline constexpr std::size_t kFooterBytes = 20;

}  // namespace vps::device::mcap
