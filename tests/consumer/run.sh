#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# run.sh BUILD_DIR WORK_DIR CMAKE [SANITIZE]
set -euo pipefail
build=$1 work=$2 cmake=$3 sanitize=${4:-}
source=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work/prefix" "$work/app"
"$cmake" --install "$build" --prefix "$work/prefix" >/dev/null
flags=""
[ -n "$sanitize" ] && flags="-fsanitize=$sanitize"
"$cmake" -G Ninja -S "$source/app" -B "$work/app" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_FLAGS="$flags" >/dev/null
"$cmake" --build "$work/app"
"$work/app/app"
"$work/app/hello_vps"
[ ! -e "$work/app/haptic_bullet" ] || "$work/app/haptic_bullet"  # not where device is not built
