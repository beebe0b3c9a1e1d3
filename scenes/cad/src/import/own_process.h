// SPDX-License-Identifier: BSD-3-Clause
// Runs a reader in a child process, so that a library's crash on a damaged file becomes a LoadError.
#pragma once

#include <functional>
#include <string>

#include "import/readers.h"

namespace vps::scenes::import {

/// Runs read() in a child process and returns its result, bit for bit. Its progress is passed to `progress`
/// in this process and thread, and its LoadError is thrown here in the same words. If the child ends without
/// a result, throws LoadError "<file>: <library> crashed while reading it; ...". `progress` is called five
/// times a second, so that it can end the child by an exception however long a library computes; the child
/// ignores Ctrl-C, which is for this process. Beyond the settings' limits of memory and time the child is
/// ended, and a LoadError says so. Other effects of read() on memory stay in the child. Without fork(), and
/// under AddressSanitizer in a program with threads, runs read() in this process.
///
/// The child is a fork of this process with the calling thread alone. For a program with more threads POSIX
/// promises little, but with glibc malloc and stdio work in the child. That suffices if `read` starts no
/// threads and no other thread of this process uses the same library, whose locks would stay locked. Cost
/// besides read(): a fork (about 1 ms for each 100 MB of this process) and one copy of the parts.
RawCad inOwnProcess(const std::string& file, const std::string& library, const ImportSettings& limits,
                    const Progress& progress, const std::function<RawCad(const Progress&)>& read);

}  // namespace vps::scenes::import
