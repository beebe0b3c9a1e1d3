#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Times of physics steps and queries, row by row, with the load average before each row: wall times need a machine that
# does nothing else. usage: tests/benchmarks/real_time.sh BUILD [ROW...]   (some ten minutes for all rows)
set -euo pipefail
build=$(realpath "${1:?usage: tests/benchmarks/real_time.sh BUILD [ROW...]}")
shift
here=$(cd "$(dirname "$0")/../.." && pwd)
peers=$build/tests/benchmarks/peers/vps_bench_peers
haptics=$build/tests/benchmarks/haptics/vps_bench_haptics
ratios=$build/tests/benchmarks/vps_benchmarks
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# The lines of a table, without its repetition at the end. A missed bound is part of the result.
row() { { "$@" || true; } 2>&1 | sed '/^$/q'; }

# The verdict of a run in real time, its missed periods, and its percentiles.
block() {
  "$build/vps" assemble "$here/scenes/bearing_block/scene.toml" --no-pictures --real-time "$@" --out "$scratch/out" \
    --json "$scratch/run.json" >"$scratch/log" 2>&1 || true
  grep -E '^(Yes|No|Not)' "$scratch/log" || tail -1 "$scratch/log"
  python3 - "$scratch/run.json" <<'PYTHON'
import json, sys
def find(value, path=""):
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from find(inner, f"{path}.{name}" if path else name)
    elif isinstance(value, list):
        yield path, len(value)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, value
wanted = ("tick_us.p99", "behind_s", "haptic.missed", "load_changes")
for path, value in find(json.load(open(sys.argv[1]))):
    if any(word in path for word in wanted) and "missed_" not in path:
        print(f"  {path} = {value:.4g}")
PYTHON
}

rows=("$@")
[ ${#rows[@]} -gt 0 ] || rows=(block points nut heap gears ring peg penalty ratios million)
for name in "${rows[@]}"; do
  echo "== $name, load average $(cut -d' ' -f1 /proc/loadavg) on $(nproc) processors"
  case $name in
    block) block ;;
    points) row "$haptics" --rows=points ;;
    nut | heap | ring | peg) row "$peers" --mode=constraint "--rows=$name" ;;
    gears) row "$peers" --mode=constraint --rows=first ;;
    penalty) row "$peers" --mode=penalty --rows=peg,nut ;;
    ratios) row "$ratios" --benchmark_filter='hot|surface|outside|peg|gears|screw' --repetitions=3 ;;
    million) row "$ratios" --benchmark_filter=million --repetitions=3 ;;
    *) echo "unknown row $name" >&2; exit 2 ;;
  esac
done
