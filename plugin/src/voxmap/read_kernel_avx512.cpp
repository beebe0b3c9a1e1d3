// SPDX-License-Identifier: BSD-3-Clause
// The kernels as compiled for processors with AVX-512 (flags: CMakeLists.txt).
#include "voxmap/lanes_avx512.h"
#include "voxmap/read_kernel.h"

namespace vps {
namespace {
#include "voxmap/read_kernel.inc"
}  // namespace

extern const ReadKernels kAvx512Kernels;
const ReadKernels kAvx512Kernels = {read, bound, touch, addRow, readAt};

}  // namespace vps
