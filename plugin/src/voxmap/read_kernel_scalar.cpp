// SPDX-License-Identifier: BSD-3-Clause
// The kernels as compiled for any processor.
#include "voxmap/lanes_plain.h"
#include "voxmap/read_kernel.h"

namespace vps {
namespace {
#include "voxmap/read_kernel.inc"
}  // namespace

extern const ReadKernels kScalarKernels;
const ReadKernels kScalarKernels = {read, bound, touch, addRow, readAt};

}  // namespace vps
