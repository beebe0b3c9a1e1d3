#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# draw.sh DATA OUT: draws the data that vps_curves or vps_bench_load wrote to DATA. Each picture stays well under 60 kB.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
if [ -e "$1/parts.dat" ]; then
  gnuplot -e "data='$1'; out='$2/load.png'; plots='$here'" "$here/load.gp"
  [ -e "$1/triangles.dat" ] || exit 0
fi
gnuplot -e "data='$1'; out='$2'; plots='$here'" "$here/accuracy.gp"
gnuplot -e "data='$1'; out='$2/query_time.png'; plots='$here'" "$here/query_time.gp"
