// SPDX-License-Identifier: BSD-3-Clause
// A reader in a process of its own, so that a library's crash on a damaged file is an error in words.
#pragma once

#include <functional>
#include <string>

#include "import/readers.h"

namespace vps::scenes::import {

/// Runs read() in a child process and returns what it returns, bit for bit. Its progress reaches `progress`,
/// in this process and thread; its LoadError is thrown here in the same words. Throws LoadError too if the
/// child ends without a result: "<file>: <library> crashed while reading it; ...". What else read() does to
/// memory stays in the child. Where there is no fork(), and under AddressSanitizer in a program with threads,
/// runs read() here.
///
/// The child is a fork of this process with the calling thread alone. From a program with more threads, POSIX
/// promises it little, but glibc makes malloc and stdio work there, and `read` needs no more if it starts no
/// threads and if no other thread uses the same library in this process, whose locks would stay taken. Cost
/// beyond read(): a fork (about 1 ms per 100 MB that this process holds) and one copy of the parts.
RawCad inOwnProcess(const std::string& file, const std::string& library, const Progress& progress,
                    const std::function<RawCad(const Progress&)>& read);

}  // namespace vps::scenes::import
