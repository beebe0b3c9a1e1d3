// SPDX-License-Identifier: BSD-3-Clause
// Interprets bytes as a sequence of steps, swapped shapes, bodies that are added and removed, and queries in
// a Bullet world. Nothing may crash, and afterwards a part still rests on a plate.
#include "fuzz.h"
#include "support/hostile_world.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The first byte selects the dispatcher.
  vps_test::HostileWorld world(vps::fuzz::require, size > 0 && data[0] % 2 == 1);
  if (size > 0) world.run(data + 1, std::min<std::size_t>(size - 1, 240));
  world.finish();
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  // Steps; each operation on each body in turn; shapes of every kind swapped between steps.
  std::string calm(1, 0), all(1, 1), swaps(1, 0);
  for (int i = 0; i < 3; ++i) calm.append({0, 3});
  for (int k = 0; k < vps_test::HostileWorld::kOperations; ++k)
    all.append({static_cast<char>(k), static_cast<char>(7 * k + k % 7)});
  for (int k = 0; k < 6; ++k)
    swaps.append({4, static_cast<char>(7 * k + k % 7), static_cast<char>(7 + k % 4),
                  static_cast<char>(7 * (k + 5) + k % 7), 0, 2});
  return {calm, all, swaps};
}
