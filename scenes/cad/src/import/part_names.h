// SPDX-License-Identifier: BSD-3-Clause
// Which of several names in a CAD file says most.
#pragma once

#include <string>

namespace vps::scenes::import {

/// The better one of the names of an instance and of its product. Names of exporters count as none: counters,
/// identifiers and kinds of shapes ("NAUO7", "=>[0:1:1:2]", "3f2a9c40-...", "SOLID"); words that any part
/// could have ("Body1", "Part 2"), names with characters that were lost, and long words of random characters
/// are only taken where there is no other. An instance that only numbers its product ("bolt:3", "bolt<3>")
/// has the product's name. Empty if neither means anything.
std::string bestName(const std::string& instance, const std::string& product);

}  // namespace vps::scenes::import
