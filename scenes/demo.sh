#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The main job on the sample assembly: installs what is missing, builds (Release), assembles the bearing block
# without a display in simulated time, and leaves report, pictures and data in out/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
.ci/install
# The same build as that of tests/run.sh: each command compiles only what the other has not compiled yet.
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
cmake --build build/release --target vps_program
exec build/release/vps assemble scenes/bearing_block/scene.toml --out out/demo "$@"
