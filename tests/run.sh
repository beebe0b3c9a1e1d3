#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds and runs every test (Release). `tests/run.sh PRESET` runs another preset.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
.ci/install
cmake --preset "$preset" -DVPS_TESTS=ON -DVPS_WERROR=ON >/dev/null
cmake --build "build/$preset"
ctest --preset "$preset" -j "$(nproc)"
