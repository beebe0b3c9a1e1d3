#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Demonstrates the program on the sample assembly: installs missing packages, builds (Release), assembles the bearing
# block without a display in simulated time, and writes report, pictures and data to out/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
.ci/install
# This script and tests/run.sh share one build: each compiles only the targets that the other has not compiled. The web
# page and the module for .vdb files are left to tests/run.sh and to 'cmake --preset release && cmake --build build/release'.
[ -f build/release/build.ninja ] || cmake --preset demo >/dev/null
cmake --build build/release --target vps_program
exec build/release/vps assemble scenes/bearing_block/scene.toml --out out/demo "$@"
