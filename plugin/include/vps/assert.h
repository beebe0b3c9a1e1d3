// SPDX-License-Identifier: BSD-3-Clause
// Checks of internal conditions: on in Debug and sanitized builds, absent in Release.
#pragma once

#ifdef VPS_ASSERT_ON
#include <cstdio>
#include <cstdlib>
#define VPS_ASSERT(condition)                                                                            \
  do {                                                                                                   \
    if (!(condition)) {                                                                                  \
      std::fprintf(stderr, "%s:%d: internal error: %s does not hold\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                                      \
    }                                                                                                    \
  } while (false)
#else
#define VPS_ASSERT(condition) static_cast<void>(0)
#endif
