// SPDX-License-Identifier: BSD-3-Clause
#include "input/process_settings.h"

#if defined(__unix__)
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#endif

#include <cstddef>

namespace vps::viewer {

void giveWay() {
#if defined(__unix__)
#ifdef SCHED_BATCH
  // A batch thread that wakes up takes the processor from no other one, however long it has slept.
  const sched_param none{};
  sched_setscheduler(0, SCHED_BATCH, &none);  // refused: it is as before
#endif
  constexpr int kNice = 10;
  if (getpriority(PRIO_PROCESS, 0) < kNice) setpriority(PRIO_PROCESS, 0, kNice);
#endif
}

void limitStacks() {
#ifdef __GLIBC__
  constexpr std::size_t kStack_bytes = 1024 * 1024;  // assumed: four times what a haptic thread touches
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return;
  if (pthread_attr_setstacksize(&attributes, kStack_bytes) == 0) pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
#endif
}

}  // namespace vps::viewer
