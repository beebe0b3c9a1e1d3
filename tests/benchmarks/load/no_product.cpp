// SPDX-License-Identifier: BSD-3-Clause
// Stands in for product_step.cpp where Open CASCADE is not found.
#include <stdexcept>

#include "product_step.h"

namespace vps::bench {

ProductSize writeProduct(const std::string& /*file*/, bool /*is_shared*/) {
  throw std::runtime_error("the product is made by Open CASCADE, which this build has not found");
}

}  // namespace vps::bench
