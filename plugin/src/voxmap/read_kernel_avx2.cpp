// SPDX-License-Identifier: BSD-3-Clause
// The kernels as compiled for processors with AVX2 (flags: CMakeLists.txt).
#include "voxmap/lanes_avx2.h"
#include "voxmap/read_kernel.h"

namespace vps {
namespace {
#include "voxmap/read_kernel.inc"
}  // namespace

extern const ReadKernels kAvx2Kernels;
const ReadKernels kAvx2Kernels = {read, bound, touch, addRow, readAt};

}  // namespace vps
