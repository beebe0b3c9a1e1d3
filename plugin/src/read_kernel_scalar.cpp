// SPDX-License-Identifier: BSD-3-Clause
// The kernels as compiled for any processor.
#include "lanes_plain.h"
#include "read_kernel.h"

namespace vps {
namespace {
#include "read_kernel.inc"
}  // namespace

extern const ReadKernels kScalarKernels;
const ReadKernels kScalarKernels = {read, bound, touch, addRow, readAt};

}  // namespace vps
