#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds and runs every test (Release). `tests/run.sh PRESET` runs another preset,
# `tests/run.sh PRESET PROGRAM...` builds and runs these test programs of it alone (test_plugin, ...), and
# `tests/run.sh fuzz [SECONDS]` feeds changed bytes to each reader of the engine, and to the device, under ASan and UBSan.
# VPS_SHARD=I/N runs only every N-th test, from the I-th on; I counts from 1.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
programs=("${@:2}")
.ci/install
if [[ $preset == fuzz ]]; then
  cmake --preset core -B build/fuzz -DVPS_COMPONENTS="plugin;vdb;device;bullet" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DVPS_SANITIZE=address,undefined -DVPS_TESTS=ON >/dev/null
  cmake --build build/fuzz --target fuzz_ply fuzz_vdb fuzz_mesh fuzz_mcap fuzz_recording fuzz_scene fuzz_device fuzz_messages fuzz_bullet
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
  for reader in ply vdb mesh mcap recording scene device messages bullet; do echo "== $reader"; build/fuzz/tests/fuzz/fuzz_$reader "${2:-60}"; done
  exit
fi
# The settings are those of scenes/demo.sh, so that both share one build; CI adds VPS_WERROR=ON.
cmake --preset "$preset" -DVPS_TESTS=ON ${VPS_WERROR:+-DVPS_WERROR="$VPS_WERROR"} >/dev/null
selection=(--output-junit tests.xml)  # which tests were skipped, and why: see .ci/check_skips
if [ ${#programs[@]} -gt 0 ]; then
  cmake --build "build/$preset" --target "${programs[@]}"
  selection+=(-L "^($(IFS='|'; echo "${programs[*]}"))\$")
else
  cmake --build "build/$preset"
fi
[ -z "${VPS_SHARD:-}" ] || selection+=(-I "${VPS_SHARD%/*},,${VPS_SHARD#*/}")
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-halt_on_error=1:print_stacktrace=1}
ctest --preset "$preset" -j "$(nproc)" "${selection[@]}"
