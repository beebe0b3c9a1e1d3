#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fails, naming file and line, where a folder includes what it may not know.
set -u
cd "$1"
failures=0
forbid() {  # forbid FOLDER... : PATTERN WHY
  local folders=()
  while [ "$1" != ":" ]; do folders+=("$1"); shift; done
  shift
  local found
  found=$(grep -rnE --include='*.h' --include='*.cpp' "$1" "${folders[@]}" 2>/dev/null | grep -vE "${3:-^$}")
  if [ -n "$found" ]; then
    echo "$2:"; echo "$found"; failures=$((failures + 1))
  fi
}
bullet='#include *[<"](bt[A-Z]|Bullet|LinearMath)'
gl='#include *[<"](epoxy|EGL|GL)/'
forbid plugin : "#include *[<\"](vps_bullet|vps_device|vps_scenes|vps_viewer)/" "plugin looks up"
forbid bullet_bridge : '#include *[<"](vps_device|vps_scenes|vps_viewer)/' "bullet_bridge looks up or sideways"
forbid device : '#include *[<"](vps_bullet|vps_scenes|vps_viewer)/' "device looks up or sideways" '^device/examples/'
forbid scenes : '#include *[<"]vps_viewer/' "scenes looks up"
forbid plugin device viewer : "$bullet" "Bullet outside of bullet_bridge" '^device/examples/'
forbid scenes : "$bullet" "Bullet in scenes outside of the simulation" '^scenes/src/simulation/'
forbid plugin bullet_bridge device scenes : "$gl" "OpenGL outside of viewer"
forbid bullet_bridge device scenes viewer : '#include *[<"](openvdb|nanovdb)/' "OpenVDB outside of plugin"
forbid bullet_bridge plugin scenes viewer : '#include *[<"](spnav|SDL)' "libspnav or SDL outside of device"
forbid bullet_bridge device plugin viewer : '#include *[<"](assimp|Inventor|TopoDS|STEPCAF)' "CAD libraries outside of scenes"
[ "$failures" -eq 0 ] && echo "boundaries hold"
exit "$failures"
