#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# draw.sh DATA OUT: pictures of what vps_curves wrote to DATA. Each stays well under 60 kB.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
gnuplot -e "data='$1'; out='$2'; plots='$here'" "$here/accuracy.gp"
gnuplot -e "data='$1'; out='$2/query_time.png'; plots='$here'" "$here/query_time.gp"
