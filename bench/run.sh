#!/usr/bin/env bash
# A part of `make bench`, within six minutes all measures that fit, into bench/results/: NAME.json and NAME.csv for each,
# the pictures of the trade, and report.html, one page with everything that opens without a network.
#   bench/run.sh [BUILD [RESULTS]]
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release} results=${2:-bench/results}
bin=$build/bench limn=$build/apps/limn
rm -rf "$results/parts"
mkdir -p "$results/parts"
start=$SECONDS
say() { printf 'limn bench %3d s: %s\n' $((SECONDS - start)) "$*" >&2; }

commands=()
# run NAME COMMAND...: its standard output becomes NAME.json, what it says on the way NAME.txt.
run() {
  local name=$1
  shift
  say "$*"
  commands+=("{\"result\":\"$name\",\"command\":\"${*//\"/\\\"}\"}")
  "$@" >"$results/$name.json" 2>"$results/$name.txt" || { tail -n 3 "$results/$name.txt" >&2; rm -f "$results/$name.json"; }
}

machine() {
  local compiler cpu
  compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' "$build/CMakeCache.txt")
  cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
  printf '[{"cpu":"%s","threads":"%s","system":"%s","compiler":"%s","commit":"%s","date of the commit":"%s","load at start":"%s"}]\n' \
    "$cpu" "$(nproc)" "$(uname -sm)" "$("$compiler" --version | head -n 1)" \
    "$(git describe --always --dirty 2>/dev/null || echo unknown)" "$(git log -1 --format=%cI 2>/dev/null || echo unknown)" \
    "$(cut -d ' ' -f 1 /proc/loadavg)"
}

# The frame table: the methods' runs in turns with the flat mesh's, at the scale where that covers half of the window.
frame_run() { "$bin/limn_bench_frames" --model "$1" --copies "$2" --size 1280x800 --samples 1 "${@:3}" 2>/dev/null | tr '\n' ' '; }
frame_scale() { frame_run "$1" "$2" --coverage 0.5 --method flat --seconds 0.01 | sed -n 's/.*scale=\([0-9.]*\).*/\1/p' || true; }
frame_line() {  # MODEL COPIES SCALE METHOD TOLERANCE
  local line
  line=$(frame_run "$1" "$2" --scale "$3" --method "$4" --tolerance "$5" --seconds 0.4) || return 0
  printf 'model=%s method=%s tolerance=%s %s\n' "$1" "$4" "$5" "$line"
}
frames() {
  local model round scale
  for model in builtin:icosphere-320 builtin:knot-480 builtin:torus-576 builtin:pawn; do
    scale=$(frame_scale $model 60)
    for round in 1 2; do
      frame_line $model 60 "$scale" flat 0.25
      for method in patches curves pn; do
        for tolerance in 2 0.5 0.1; do frame_line $model 60 "$scale" $method $tolerance; done
      done
    done
  done
  scale=$(frame_scale builtin:icosphere:8 1)  # one large mesh
  for round in 1 2; do
    for method in flat patches curves; do frame_line builtin:icosphere:8 1 "$scale" $method 0.5; done
  done
}
# key=value lines -> rows: least times per model, method and tolerance, beside the flat mesh's.
frame_rows() {
  awk '{
    delete v
    for (i = 1; i <= NF; ++i) { split($i, kv, "="); v[kv[1]] = kv[2] }
    key = v["model"] SUBSEP v["method"] SUBSEP v["tolerance"]
    if (!(key in least)) { order[++n] = key; least[key] = 1e30 }
    if (v["min_ms"] + 0 < least[key]) least[key] = v["min_ms"] + 0
    median[key] = v["median_ms"] + 0; tris[key] = v["tris_drawn"] + 0; allocs[key] = v["allocs_per_frame"] + 0
    if (v["method"] == "flat") { if (!(v["model"] in flat) || v["min_ms"] + 0 < flat[v["model"]]) flat[v["model"]] = v["min_ms"] + 0; flatTris[v["model"]] = v["tris_drawn"] + 0 }
  } END {
    printf "["
    for (i = 1; i <= n; ++i) {
      split(order[i], k, SUBSEP); key = order[i]; more = tris[key] - flatTris[k[1]]
      printf "%s\n  {\"model\":\"%s\",\"method\":\"%s\",\"tolerance\":%s,\"min_ms\":%.4f,\"median_ms\":%.4f,\"times_flat\":%.4f,\"tris_drawn\":%d,\"ns_per_added_triangle\":%.1f,\"allocs_per_frame\":%.3f,\"disturbed\":%s}", \
        (i > 1 ? "," : ""), k[1], k[2], k[3], least[key], median[key], (flat[k[1]] > 0 ? least[key] / flat[k[1]] : 0), tris[key], \
        (more > 0 ? (least[key] - flat[k[1]]) * 1e6 / more : 0), allocs[key], (median[key] > 1.5 * least[key] ? "true" : "false")
    }
    print "\n]"
  }'
}

# Rows of one line each, as all files here have them -> CSV.
csv() {
  awk '/^ *\{/ {
    sub(/^ *\{"/, ""); sub(/\},?$/, "")
    n = split($0, pair, /,"/); keys = values = ""
    for (i = 1; i <= n; ++i) {
      at = index(pair[i], "\":")
      keys = keys (i > 1 ? "," : "") substr(pair[i], 1, at - 1)
      values = values (i > 1 ? "," : "") substr(pair[i], at + 2)
    }
    if (!said++) print keys
    print values
  }' "$1"
}

machine >"$results/machine.json"
# Where measuring is slow because others use the machine, the rest is done quickly: all within ten minutes.
quick() { if ((SECONDS - start > $1)); then echo --quick; fi; }

if [[ -x $bin/limn_bench_frames ]]; then
  say "frame table"
  commands+=('{"result":"frames","command":"limn_bench_frames --model MODEL --copies 60 --size 1280x800 --scale S --method METHOD --tolerance PX --samples 1 --seconds 0.4"}')
  frames >"$results/frames.txt"
  frame_rows <"$results/frames.txt" >"$results/frames.json"
  grep -q 'model' "$results/frames.json" || rm -f "$results/frames.json"
fi
if [[ -x $bin/limn_microbench ]]; then
  run microbench-full "$bin/limn_microbench" --benchmark_format=json --benchmark_min_time=0.1
fi
run stability "$bin/limn_measure" stability --quick --csv "$results/stability.csv"
run trade "$bin/limn_measure" trade --quick --plot "$results" --csv "$results/trade.csv"
run outline "$bin/limn_measure" outline $(quick 200) --method flat,patches,curves,pn:4 --csv "$results/outline.csv"
run coherence "$bin/limn_measure" coherence --quick --csv "$results/coherence.csv" --size 512 \
  --model builtin:sphere-200 --model builtin:torus-576 --model builtin:knot-480

say "pictures"
for group in analytic modelled; do
  [[ -f $results/trade-$group.dat ]] && gnuplot -e "dir='$results'; group='$group'" bench/trade.gp
done
for model in sphere-200 torus-576 knot-480 pawn cone-70; do
  for method in flat patches curves pn; do
    "$limn" render builtin:$model --method $method --size 900x900 --background '#ffffff' --quiet \
      -o "$results/parts/frame~$model~$method.png" 2>/dev/null || true
  done
  "$bin/limn_measure" outline --model builtin:$model --method flat,patches --seed 5 --views 1 --dump "$results/parts/dump" \
    >/dev/null 2>&1 || true
  for method in flat patches; do
    for file in "$results"/parts/dump/builtin-$model-$method-*.png; do
      [[ -f $file ]] && mv "$file" "$results/parts/difference~$model~$method.png"
    done
  done
done
for group in analytic modelled; do
  [[ -f $results/trade-$group.svg ]] && cp "$results/trade-$group.svg" "$results/parts/plot~$group~trade.svg"
done
(IFS=,; printf '[%s]\n' "${commands[*]}") >"$results/commands.json"

say "report"
if [[ -f $results/microbench-full.json ]]; then
  # Google Benchmark's own form -> rows.
  awk 'BEGIN { printf "[" }
    /"name":/ { gsub(/.*"name": "|",?$/, ""); name = $0 }
    /"real_time":/ { gsub(/[^0-9.e+-]/, ""); time = $0 }
    /"time_unit":/ { gsub(/.*"time_unit": "|",?$/, ""); printf "%s\n  {\"benchmark\":\"%s\",\"time\":%s,\"unit\":\"%s\"}", (n++ ? "," : ""), name, time, $0 }
    END { print "\n]" }' "$results/microbench-full.json" >"$results/microbench.json"
fi
{
  sed '/^@DATA@$/,$d' bench/report/page.html
  echo '<script>'
  for file in "$results"/*.json; do
    name=$(basename "$file" .json)
    [[ $name == *-full || $name == race ]] && continue
    printf 'window.rows["%s"] = ' "$name"
    cat "$file"
    echo ';'
  done
  for name in race linear; do
    [[ -f $results/$name.md ]] && printf 'window.texts["%s"] = decodeURIComponent(escape(atob("%s")));\n' $name "$(base64 -w 0 "$results/$name.md")"
  done
  for file in "$results"/parts/*.png "$results"/parts/*.svg; do
    [[ -f $file ]] || continue
    name=$(basename "${file%.*}")
    kind=png
    [[ $file == *.svg ]] && kind=svg+xml
    printf 'window.pictures["%s"] = "data:image/%s;base64,' "${name//\~//}" "$kind"
    base64 -w 0 "$file"
    echo '";'
  done
  echo '</script>'
  sed '1,/^@DATA@$/d' bench/report/page.html
} >"$results/report.html"
rm -rf "$results/parts"
for name in frames microbench; do
  [[ -f $results/$name.json ]] && csv "$results/$name.json" >"$results/$name.csv"
done
bench/report/check.sh "$results/report.html"
say "done: $results/report.html"
