#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# side_by_side.sh DOUBLE_BUILD SINGLE_BUILD WORK_DIR [CMAKE]
# Installs the packages for Bullet's two precisions in one prefix: no file of one package replaces a file of the other, and a
# program gets the package that it requests.
set -euo pipefail
double=$(realpath "$1") single=$(realpath "$2") work=$(realpath -m "$3") cmake=${4:-cmake}
source=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work"
prefix=$work/prefix

"$cmake" --install "$double" --prefix "$prefix" >/dev/null
(cd "$prefix" && find . -type f -exec sha256sum {} +) >"$work/of_double"
"$cmake" --install "$single" --prefix "$prefix" >/dev/null
(cd "$prefix" && sha256sum --quiet -c "$work/of_double") || { echo "the second package replaces files of the first"; exit 1; }

build() {  # build NAME [OPTION...]
  local name=$1
  shift
  "$cmake" -G Ninja -S "$source/app" -B "$work/$name" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_DISABLE_FIND_PACKAGE_tomlplusplus=ON "$@" >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
  "$cmake" --build "$work/$name" >/dev/null
  "$work/$name/app"
}
# `ldd | grep -q` would not work: grep ends at its first match, ldd then fails at its next write, and pipefail reports it.
of_double() { grep -q "BulletDynamics-float64" <<<"$(ldd "$1")"; }
build double -DVPS_BULLET_DOUBLE=ON
of_double "$work/double/app" || { echo "not the package in double precision"; exit 1; }
build single -DVPS_BULLET_DOUBLE=OFF
if of_double "$work/single/app"; then echo "not the package in single precision"; exit 1; fi
build neither
of_double "$work/neither/app" || { echo "without a wish, not the package in double precision"; exit 1; }

export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name vps-bullet.pc)")
for suffix in "" -float32; do
  ${CXX:-c++} -std=c++20 "$source/app/app.cpp" -o "$work/by_pkg_config$suffix" $(pkg-config --cflags --libs "vps-bullet$suffix")
  "$work/by_pkg_config$suffix"
done
echo "side by side"
