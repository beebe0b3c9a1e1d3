#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# precision.sh CXX double|single BUILD_DIR WORK_DIR BULLET_INCLUDE EIGEN_INCLUDE [SANITIZE]
# A program that mixes Bullet's precisions: every public header is a compile error in the other precision, and if only the
# libraries are mixed, install() throws an error with a message.
set -euo pipefail
cxx=$1 ours=$2 build=$3 work=$4 bullet=$5 eigen=$6 sanitize=${7:-}
root=$(cd "$(dirname "$0")/../.." && pwd)
rm -rf "$work"
mkdir -p "$work"
flags=(-std=c++20 -DVPS_PLUGIN_STATIC_DEFINE -DVPS_BULLET_STATIC_DEFINE -I"$root/bullet_bridge/include" -I"$root/plugin/include"
  -I"$build/include" -isystem "$bullet" -isystem "$eigen")
double=(-DBT_USE_DOUBLE_PRECISION)
single=()
if [ "$ours" = double ]; then
  same=("${double[@]}") other=("${single[@]}") same_suffix=-float64 other_suffix="" ours_suffix=""
else
  same=("${single[@]}") other=("${double[@]}") same_suffix="" other_suffix=-float64 ours_suffix=-float32
fi

for header in "$root"/bullet_bridge/include/vps_bullet/*.h "$build/include/vps_bullet/precision.h"; do
  name=vps_bullet/$(basename "$header")
  echo "#include <$name>" >"$work/one.cpp"
  if "$cxx" "${flags[@]}" ${other[@]+"${other[@]}"} -fsyntax-only "$work/one.cpp" 2>"$work/said"; then
    echo "$name compiles in the other precision"
    exit 1
  fi
  grep -q "vps::bullet was built for Bullet in" "$work/said" || { echo "$name does not say why"; head -5 "$work/said"; exit 1; }
done

# Libraries of the other precision come first, so that the dispatcher is theirs.
library() { "$cxx" -print-file-name="lib$1.so"; }
[ -e "$(library "BulletCollision$other_suffix")" ] || { echo "only one of Bullet's precisions is installed"; exit 0; }
cat >"$work/mixed.cpp" <<'END'
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <vps_bullet/install.h>

#include <cstdio>
#include <stdexcept>

int main() {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  try {
    vps::bullet::install(dispatcher);
  } catch (const std::invalid_argument& error) {
    std::puts(error.what());
    return 0;
  }
  std::puts("accepted");
  return 1;
}
END
link=("$build/bullet_bridge/libvps_bullet$ours_suffix.a" "$build/plugin/libvps_plugin$ours_suffix.a")
mixed=() right=()
for part in BulletDynamics BulletCollision LinearMath; do
  mixed+=("-l$part$other_suffix")
  right+=("-l$part$same_suffix")
done
[ -n "$sanitize" ] && flags+=("-fsanitize=$sanitize")
"$cxx" "${flags[@]}" ${same[@]+"${same[@]}"} "$work/mixed.cpp" "${link[@]}" "${mixed[@]}" "${right[@]}" -ltbb -o "$work/mixed"
said=$("$work/mixed") || { echo "libraries of both precisions: $said"; exit 1; }
grep -q "another precision" <<<"$said" || { echo "does not say why: $said"; exit 1; }
"$cxx" "${flags[@]}" ${same[@]+"${same[@]}"} "$work/mixed.cpp" "${link[@]}" "${right[@]}" -ltbb -o "$work/right"
if "$work/right" >/dev/null; then
  echo "the right libraries were refused"
  exit 1
fi
