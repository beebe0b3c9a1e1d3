// SPDX-License-Identifier: BSD-3-Clause
// Settings of this process with its operating system (POSIX). Where the system has none of that, they do
// nothing.
#pragma once

namespace vps::viewer {

/// Others go first where the processor is busy; also for threads that are started later.
void giveWay();

/// Gives threads that are started later stacks of 1 MiB. The memory of a process that drives a device is
/// locked, so each thread's stack is there as a whole, also that of a thread that has ended, until another
/// one takes it over.
void limitStacks();

}  // namespace vps::viewer
