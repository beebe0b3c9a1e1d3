// SPDX-License-Identifier: BSD-3-Clause
// Computes independent results in forked copies of this process.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace vps::scenes::inline v0::import {

/// make(order[0]), make(order[1]) and so on, by as many forked copies of this process as there are cores, and
/// at index i of the result what make(i) returned, byte for byte. `order` names each of 0 to n - 1 once; the
/// next index goes to the copy that is free. `done` is called in this process after each. What a copy does
/// not return, since it crashed or its make() threw, is made in this process, so that it fails here as it
/// would without copies. Without fork(), on one core, and for one result, all are made here.
///
/// For a library that is not known to be safe in threads, and in a process that may start none: the child
/// that reads a file. The copies end with this process.
std::vector<std::string> madeInCopies(const std::vector<std::size_t>& order,
                                      const std::function<std::string(std::size_t)>& make,
                                      const std::function<void()>& done);

}  // namespace vps::scenes::inline v0::import
