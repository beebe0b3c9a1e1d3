#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The specification of contact as one command: runs every table that pins it, prints one table of all rows (row,
# bound, value, verdict, processor time), and compares two of them. tests/README.md says what it runs.
#
#   tests/core_table.sh BUILD [--long] [--out DIR] [--only WORDS] [--jobs N] [--limit SECONDS]
#   tests/core_table.sh --compare A.tsv B.tsv
#
# Exit status: 0 if each row is met or fails as expected, 1 if one failed, crashed, timed out or was not built, 2 for a
# wrong option. --compare: 1 if a row's verdict became worse. Needs bash, awk and coreutils.
set -uo pipefail
export LC_ALL=C
tests=$(cd "$(dirname "$0")" && pwd)

usage() {
  sed -n '6,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
}

# Verdicts with which a table is good. "-": reported, not judged.
good='met|expected|-|skipped|by another mode'

# Prints the rows of a file in columns, and the number of rows of each verdict.
print_table() {
  awk -F'\t' '
    function cut(s, n) { return length(s) > n ? substr(s, 1, n - 2) ".." : s }
    NR == 1 { printf "%-62s %-30s %-52s %-10s %8s\n", "row", "bound", "value", "verdict", "CPU [s]"; next }
    { printf "%-62s %-30s %-52s %-10s %8s\n", cut($1, 62), cut($2, 30), cut($3, 52), $4, $5
      ++count[$4]; cpu_s += $5 }
    END { printf "%d rows, %.0f s of processor time:", NR - 1, cpu_s
          for (v in count) printf " %d %s,", count[v], v
          print "" }' "$1"
}

# Compares two tables. A row has moved if its verdict or its value changed; a time, whose unit is ms, us or s, if it
# changed by more than half.
compare() {
  awk -F'\t' -v good="^($good)\$" '
    function cut(s, n) { return length(s) > n ? substr(s, 1, n - 2) ".." : s }
    function isTime(v) { return v ~ /(^| )[0-9.e+-]+ (ms|us|s)$/ }
    function number(v,  w, n) { n = split(v, w, " "); return w[n - 1] + 0 }
    function moved(a, b,  x, y) {
      if (a == b) return 0
      if (!isTime(a) || !isTime(b)) return 1
      x = number(a); y = number(b)
      return x <= 0 || y <= 0 || y > 1.5 * x || x > 1.5 * y
    }
    function line(mark, row, bound, va, vb, a, b) {
      printf "%-2s %-60s %-24s %-38s %-38s %s\n", mark, cut(row, 60), cut(bound, 24), cut(va, 38), cut(vb, 38),
             a == b ? a : a " -> " b
    }
    FNR == 1 { ++file; next }
    file == 1 { value[$1] = $3; verdict[$1] = $4; bound[$1] = $2; order[++n] = $1; next }
    { value2[$1] = $3; verdict2[$1] = $4; if (!($1 in value)) { added[++m] = $1; bound[$1] = $2 } }
    END {
      print "   row, bound, first, second, verdict.  *: value moved, !: verdict changed, +: new, x: gone"
      for (i = 1; i <= n; ++i) {
        r = order[i]
        if (!(r in value2)) { line("x", r, bound[r], value[r], "", verdict[r], "gone"); ++gone
                              if (verdict[r] ~ good) ++worse; continue }
        mark = verdict[r] != verdict2[r] ? "!" : moved(value[r], value2[r]) ? "*" : ""
        if (mark == "!") ++changed
        if (mark == "*") ++moves
        if (verdict[r] ~ good && verdict2[r] !~ good) ++worse
        line(mark, r, bound[r], value[r], value2[r], verdict[r], verdict2[r])
      }
      for (i = 1; i <= m; ++i) { r = added[i]; line("+", r, bound[r], "", value2[r], "new", verdict2[r])
                                 if (verdict2[r] !~ good) ++worse }
      printf "%d rows: %d moved, %d verdicts changed, %d new, %d gone; %d worse\n", n + m, moves, changed, m, gone, worse
      exit worse > 0
    }' "$1" "$2"
}

# Rows of a GoogleTest program, from the lines that it prints at the end of each test.
rows_of_gtest() {  # NAME LOG
  awk -v name="$1" '
    /^\[       OK \] .*\(.* ms\)$/ { add("met") }
    /^\[  FAILED  \] .*\(.* ms\)$/ { add("FAILED") }
    /^\[  SKIPPED \] .*\(.* ms\)$/ { add("skipped") }
    function add(verdict,  s, ms) {
      s = $0; sub(/^\[[^]]*\] /, "", s); ms = s; sub(/.*\(/, "", ms); sub(/ ms\)$/, "", ms)
      sub(/,? \([^()]*\)$/, "", s); sub(/, where .*/, "", s)
      printf "%s %s\tholds\t%s\t%s\t%.1f\n", name, s, verdict == "met" ? "holds" : verdict, verdict, ms / 1000
    }' "$2"
}

# Rows of the demo: verdict and depth of each part from steps.csv, times from assemble.json.
rows_of_demo() {  # FOLDER
  awk -F, '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    { part = $column["part"]; v = $column["verdict"]
      printf "demo %s: verdict\tfits\t%s\t%s\t%.1f\n", part, v, v == "fits" ? "met" : "FAILED", 0
      d = 1e6 * $column["max_penetration_m"]; l = 1e6 * $column["penetration_limit_m"]
      printf "demo %s: deepest\t<= %.2f um\t%.3f um\t%s\t0.0\n", part, l, d, d <= l ? "met" : "FAILED" }' "$1/steps.csv"
  awk '/"haptic_us"|"physics_us"|"haptic"|"physics"/ { split($0, w, "\""); of = w[2] }
    /"(cpu_)?p99"/ { split($0, w, "\""); v = $2; sub(/,$/, "", v)
      printf "demo %s: %s\t\t%.0f us\t-\t0.0\n", of, w[2], v }' "$1/assemble.json"
}

# One job: a program with its time limit. Writes its rows to $out/NAME.rows and its output to $out/NAME.log.
job() {  # NAME LIMIT_S KIND PROGRAM ARGUMENTS...
  local name=$1 limit_s=$2 kind=$3 program=$4 status cpu
  shift 4
  local rows=$out/$name.rows log=$out/$name.log
  : >"$rows"
  if [ ! -x "$program" ]; then
    printf '%s\truns\tno %s\tNOT BUILT\t0.0\n' "$name" "$program" >"$rows"
    return
  fi
  TIMEFORMAT='%U %S'
  { time timeout "$limit_s" "$program" "$@" >"$log" 2>&1; } 2>"$out/$name.time"
  status=$?
  cpu=$(awk '{ printf "%.1f", $1 + $2 }' "$out/$name.time")
  if [ "$kind" = gtest ]; then rows_of_gtest "$name" "$log" >"$rows"; fi
  if [ "$kind" = demo ] && [ -f "$out/demo/steps.csv" ]; then rows_of_demo "$out/demo" >"$rows"; fi
  local verdict=met value="exit status $status"
  if [ $status -eq 124 ]; then verdict="TIMED OUT" value="after $limit_s s"
  elif [ $status -gt 128 ]; then verdict=CRASHED value="signal $((status - 128))"
  elif [ $status -gt 1 ]; then verdict="DID NOT RUN" value=$(tail -n 1 "$log" | tr '\t' ' ')
  elif [ ! -s "$rows" ]; then verdict=FAILED value="no rows"
  elif [ $status -eq 1 ] && ! awk -F'\t' -v good="^($good)\$" '$4 !~ good { bad = 1 } END { exit !bad }' "$rows"; then
    verdict=FAILED
  fi
  # If the program ends well, its rows are complete.
  [ "$verdict" = met ] || printf '%s: program\tends well\t%s\t%s\t%s\n' "$name" "$value" "$verdict" "$cpu" >>"$rows"
}

# Jobs run two at a time, in the order in which they are added, the longest first; rows keep the order of names.
names=()
add() {  # as job(); only jobs that --only names
  [ -n "$only" ] && [[ ! $1 =~ $only ]] && return
  names+=("$1")
  while [ "$(jobs -rp | wc -l)" -ge "$parallel" ]; do wait -n || true; done
  printf '%s  %s\n' "$(date +%T)" "$1" >&2
  job "$@" &
}

if [ "${1:-}" = --compare ]; then
  if [ $# -ne 3 ] || [ ! -f "$2" ] || [ ! -f "$3" ]; then usage; fi
  compare "$2" "$3"
  exit
fi
build=${1:-}
[ -d "$build" ] || usage
build=$(cd "$build" && pwd)
shift
is_long=false out="" only="" parallel=2 limit=""
while [ $# -gt 0 ]; do
  case $1 in
    --long) is_long=true ;;
    --out) out=${2:?} && shift ;;
    --only) only=${2:?} && shift ;;
    --jobs) parallel=${2:?} && shift ;;
    --limit) limit=${2:?} && shift ;;
    *) usage ;;
  esac
  shift
done
[ -n "$out" ] || out=$(mktemp -d)
mkdir -p "$out" && out=$(cd "$out" && pwd) || exit 2

bin=$build/tests
short=--short every=16 runs=2 seeds=1
if $is_long; then short="" every=8 runs=20 seeds=8; fi
if [ -z "$limit" ]; then $is_long && limit=14400 || limit=1500; fi  # of one program [s]

# The longest jobs come first. The edge table is split, so that its parts run in parallel with other programs.
for part in 0 1; do
  add "hand_edge_$part" $limit rows "$bin/hand/vps_hand" edge --every $((2 * every)) --from $((part * every)) --tsv "$out/hand_edge_$part.rows"
done
add search $limit rows "$bin/search/vps_search" --seed 1 --runs $runs --save "$out/search" --tsv "$out/search.rows"
for row in nut lock heap; do  # at full length these take longer than all others together
  add "peers_$row" $limit rows "$bin/benchmarks/peers/vps_bench_peers" --rows=$row ${short:+$short} --tsv="$out/peers_$row.rows"
done
add hand_screw $limit rows "$bin/hand/vps_hand" coarse_thread 1 $seeds --tsv "$out/hand_screw.rows"
add demo $limit demo "$build/vps" assemble "$tests/../scenes/bearing_block/scene.toml" --no-pictures --out "$out/demo"
add stability $limit rows "$bin/stability/vps_stability" ${short:+$short} --tsv="$out/stability.rows"
add missed_contact $limit gtest "$bin/test_bullet_bridge" --gtest_filter='*MissedContact*'
add hand_guided $limit gtest "$bin/hand/test_hand" --gtest_filter='Guided.*:Screw.*'
for row in ladder longrest gears; do
  add "peers_$row" $limit rows "$bin/benchmarks/peers/vps_bench_peers" --rows=$row ${short:+$short} --tsv="$out/peers_$row.rows"
done
add peers_others $limit rows "$bin/benchmarks/peers/vps_bench_peers" ${short:+$short} \
  --rows=peg,ring,massrest,impact,inside,proxy,wall,query,shapes,pairs,first --tsv="$out/peers_others.rows"
scenes=${VPS_PEER_SCENES_DIR:-$tests/../../shared/peer_scenes}
if [ -d "$scenes" ]; then
  add peer_scenes $limit rows "$bin/peer_scenes/vps_peer_scenes" "$scenes" --tsv="$out/peer_scenes.rows"
elif [[ -z $only || peer_scenes =~ $only ]]; then
  names+=(peer_scenes)
  printf 'peer_scenes\truns\tno folder %s\tskipped\t0.0\n' "$scenes" >"$out/peer_scenes.rows"
fi
add replay $limit gtest "$bin/test_scenes_run" --gtest_filter='*Replay*'
for kind in G H J M N A B C D E F I K L; do
  add "families_$kind" $limit rows "$bin/families/vps_families" --families=$kind ${short:+$short} --tsv="$out/families_$kind.rows"
done
wait

table=$out/table.tsv
printf 'row\tbound\tvalue\tverdict\tcpu_s\n' >"$table"
for name in $(printf '%s\n' "${names[@]}" | sort); do cat "$out/$name.rows"; done >>"$table"
print_table "$table"
echo "written as $table"
awk -F'\t' -v good="^($good)\$" 'NR > 1 && $4 !~ good { bad = 1 } END { exit bad }' "$table"
