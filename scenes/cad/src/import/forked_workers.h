// SPDX-License-Identifier: BSD-3-Clause
// Computes independent results in forked copies of this process.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace vps::scenes::import {

/// Whether a fork of this process can compute. AddressSanitizer's malloc, unlike glibc's, does not work in
/// the fork of a program with threads: a lock that one of them held stays locked (GCC 12: the child hangs).
bool mayFork();

/// make(order[0]), make(order[1]) and so on, by as many forked copies of this process as there are cores, and
/// at index i of the result what make(i) returned, byte for byte. `order` names each of 0 to n - 1 once; the
/// next index goes to the copy that is free. `done` is called in this process after each. What a copy does
/// not return, since it crashed or its make() threw, is made in this process, so that it fails here as it
/// would without copies. Where mayFork() says no, with one copy, and for one result, all are made here.
/// @param copies  0: as many as there are cores
///
/// For a library that is not known to be safe in threads, and in a process that may start none: the child
/// that reads a file. The copies end with this process.
std::vector<std::string> madeInCopies(const std::vector<std::size_t>& order,
                                      const std::function<std::string(std::size_t)>& make,
                                      const std::function<void()>& done, std::size_t copies = 0);

}  // namespace vps::scenes::import
