#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# run.sh static|shared BUILD_DIR WORK_DIR CMAKE [SANITIZE]
# static: installs BUILD_DIR; shared: builds and installs plugin and bullet as shared libraries. Then builds and runs
# programs outside of the tree against the installed package alone: by find_package(vps), where the packages of
# components that were not requested cannot be found, and by pkg-config.
set -euo pipefail
kind=$1 build=$2 work=$3/$1 cmake=$4 sanitize=${5:-}
source=$(cd "$(dirname "$0")" && pwd)
root=$source/../..
rm -rf "$work"
mkdir -p "$work"

if [ "$kind" = shared ]; then
  double=$(sed -n 's/^VPS_BULLET_DOUBLE:BOOL=//p' "$build/CMakeCache.txt")
  build=$work/build
  "$cmake" -G Ninja -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Debug -DBUILD_SHARED_LIBS=ON -DVPS_COMPONENTS=bullet \
    -DVPS_TESTS=OFF -DVPS_BULLET_DOUBLE="$double" >/dev/null
  "$cmake" --build "$build" >"$work/build.log" 2>&1 || { tail -60 "$work/build.log"; exit 1; }
fi
"$cmake" --install "$build" --prefix "$work/prefix" >/dev/null
prefix=$work/prefix
suffix=""  # suffix of the package's names
grep -q '^VPS_BULLET_DOUBLE:BOOL=OFF' "$build/CMakeCache.txt" && suffix=-float32
include=$prefix/include${suffix:+/vps$suffix}
libs=$(dirname "$(find "$prefix" -name 'libvps_plugin*' -print -quit)")
export LD_LIBRARY_PATH=$libs${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
flags=""
[ -n "$sanitize" ] && flags="-fsanitize=$sanitize"

quiet() {  # quiet COMMAND...: its output only if it fails
  local said
  said=$("$@" 2>&1) || { echo "$said"; exit 1; }
}
missing() { for package in "$@"; do echo "-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"; done; }
configure() {  # configure FOLDER NAME [OPTION...]: FOLDER as a project of its own, in $work/NAME
  local folder=$1 name=$2
  shift 2
  "$cmake" -G Ninja -S "$source/$folder" -B "$work/$name" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_CXX_FLAGS="$flags" "$@" 2>&1
}
refused() {  # refused WORDS CONFIGURE-ARGUMENT...: must fail, with these words in the output
  local words=$1 said
  shift
  if said=$(configure "$@"); then
    echo "should have been refused: $*"
    exit 1
  fi
  grep -qF "$words" <<<"$(tr -s ' \n' ' ' <<<"$said")" || { echo "does not say '$words': $said"; exit 1; }
}
others=(VpsOpenVDB assimp PNG Freetype VpsEpoxy OpenCASCADE Coin)  # packages of components that are not requested here

echo "== find_package(vps COMPONENTS bullet)"
quiet configure app app $(missing "${others[@]}" tomlplusplus)
quiet "$cmake" --build "$work/app"
"$work/app/app"
# The shared libraries are built without optimization, in which a second of simulated time takes minutes.
[ "$kind" = shared ] || "$work/app/hello_vps"

if [ "$kind" = static ]; then
  echo "== the examples"
  quiet configure examples examples
  quiet "$cmake" --build "$work/examples"
  "$work/examples/gear_train"
fi

echo "== find_package(vps COMPONENTS plugin)"
quiet configure plugin_alone plugin_alone $(missing "${others[@]}" tomlplusplus VpsBullet)
quiet "$cmake" --build "$work/plugin_alone"
"$work/plugin_alone/plugin_alone"

echo "== what is missing is named"
refused "vps::bullet needs VpsBullet" plugin_alone refused_1 -DVPS_ASKED=bullet $(missing VpsBullet)
refused "vps::nonsense is not installed here" plugin_alone refused_2 -DVPS_ASKED=nonsense
if [ -e "$include/vps/vdb.h" ] && [ "$kind" = static ]; then
  refused "vps::vdb needs VpsOpenVDB" plugin_alone refused_3 -DVPS_ASKED=vdb $(missing VpsOpenVDB)
fi

if [ "$kind" = static ] && [ -e "$include/vps_device" ]; then
  echo "== find_package(vps COMPONENTS bullet OPTIONAL_COMPONENTS device)"
  quiet configure app haptic $(missing "${others[@]}")
  quiet "$cmake" --build "$work/haptic" --target haptic_bullet
  "$work/haptic/haptic_bullet"

  echo "== an installed component without those that it does not require"
  whole=$prefix
  prefix=$work/one
  "$cmake" --install "$build" --prefix "$prefix" --component plugin >/dev/null
  quiet configure plugin_alone plugin_only $(missing "${others[@]}" tomlplusplus VpsBullet)
  quiet "$cmake" --build "$work/plugin_only"
  "$work/plugin_only/plugin_alone"
  refused "its install component 'bullet'" plugin_alone refused_4 -DVPS_ASKED=bullet
  prefix=$whole
fi

echo "== pkg-config"
export PKG_CONFIG_PATH=$libs/pkgconfig
${CXX:-c++} -std=c++20 $flags "$source/plugin_alone/plugin_alone.cpp" -o "$work/by_pkg_config" \
  $(pkg-config --cflags --libs vps-plugin$suffix)
"$work/by_pkg_config"
${CXX:-c++} -std=c++20 -O2 $flags "$source/app/app.cpp" -o "$work/app_by_pkg_config" $(pkg-config --cflags --libs vps-bullet$suffix)
"$work/app_by_pkg_config"

if [ "$kind" = shared ]; then
  echo "== the shared libraries"
  version=$(pkg-config --modversion "vps-plugin$suffix")
  grep -q "soname: \[libvps_plugin$suffix.so.${version%.*}\]" <<<"$(readelf -d "$libs/libvps_plugin$suffix.so")"
  grep -q "NEEDED.*libvps_bullet$suffix.so.${version%.*}" <<<"$(readelf -d "$work/app/app")"
  # Of all functions defined in the libraries, those that public headers declare are exported. An overload or a private
  # function may be hidden where another of its name is not.
  for name in plugin bullet; do
    symbols=$(nm -C "$libs/libvps_$name$suffix.so" | sed -n 's/^[0-9a-f]* \([tT]\) \(vps::[^(]*\)(.*/\1 \2/p' | sort -u)
    folder=$include/vps
    [ "$name" = plugin ] || folder=${folder}_$name
    declared=$(ctags -R --languages=C++ --langmap=C++:+.h --kinds-C++=p --extras=+q -f - "$folder" | cut -f1 | sort -u)
    hidden=$(comm -23 <(sed -n 's/^t //p' <<<"$symbols") <(sed -n 's/^T //p' <<<"$symbols") | comm -12 - <(echo "$declared"))
    [ -z "$hidden" ] || { echo "public functions of vps::$name that are not exported:"; echo "$hidden"; exit 1; }
    grep -q '^T ' <<<"$symbols" || { echo "vps::$name exports nothing"; exit 1; }
  done
  exported=$(nm -DC --defined-only "$libs/libvps_plugin$suffix.so")
  if grep 'vps::\(sampleFeatures\|joinCoarse\|readKernels\)(' <<<"$exported"; then
    echo "these are private, and are exported"
    exit 1
  fi
fi
