// SPDX-License-Identifier: BSD-3-Clause
// Which part of one revision is which part of the other one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "revisions/shape_change.h"

namespace vps::scenes {

/// The name that equal parts of a revision share: the name without the counter that the import adds
/// ("bolt_2"), if the revision has a part of that name with an equal shape; else the name itself.
std::vector<std::string> instanceNames(const std::vector<RevisedPart>& parts);

/// For each part of the new revision, the index of the same part in the old one; empty: the part was added.
///
/// Matched in this order, each part at most once:
/// 1. parts of one instance name, those of equal shape first, then the nearest places first;
/// 2. parts of one name;
/// 3. parts of equal shape and place, whatever their names.
/// Ties are broken by equal names, then by the order of the parts.
std::vector<std::optional<std::size_t>> matchParts(const std::vector<RevisedPart>& before,
                                                   const std::vector<RevisedPart>& after);

}  // namespace vps::scenes
