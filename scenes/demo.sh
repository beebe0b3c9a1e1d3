#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The main job on the sample assembly: installs what is missing, builds (Release), assembles the bearing block
# without a display in simulated time, and leaves report, pictures and data in out/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
.ci/install
[ -f build/release/build.ninja ] || cmake --preset release -DVPS_TESTS=OFF >/dev/null
cmake --build build/release --target vps_program
exec build/release/vps assemble scenes/bearing_block/scene.toml --out out/demo "$@"
