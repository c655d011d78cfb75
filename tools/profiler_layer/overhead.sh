#!/usr/bin/env bash
# What the profiling layer costs: frames of one scene without it and at each granularity, in turns, so that whatever else the machine
# does meets all alike. Prints a table: medians, least, most, and the median ratio to the same round's frames without the layer.
#
#   tools/profiler_layer/overhead.sh [ROUNDS [RENDER ARGUMENTS…]]     5 rounds of builtin:atrium at 640x360
#
# Needs jq. BUILD says where the build is; LOCK is put before each round, for machines where measuring has to be announced.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
build=${BUILD:-$root/build}
rounds=${1:-5}
[[ $# -eq 0 ]] || shift
[[ $# -gt 0 ]] || set -- builtin:atrium --size 640x360
# The first image of each run is left out: it is there to warm up. Each round begins with another mode.
modes=(none frame pass dispatch)
round() {
  local number=$1 mode turn
  shift
  for turn in 0 1 2 3; do
    mode=${modes[(number + turn) % 4]}
    env VK_LAYER_PATH="$build/layers" VK_INSTANCE_LAYERS="$([[ $mode == none ]] || echo VK_LAYER_MYRIAD_profiler)" \
      MYRIAD_PROFILER_GRANULARITY="${mode/none/frame}" MYRIAD_PROFILER_OUTPUT_FILE="$folder/trace.json" XDG_DATA_HOME="$folder" \
      "$build/bin/myriad" render "$@" --repeat 4 --quiet -o "$folder/image.exr" --stats "$folder/$mode.$number.stats"
    jq '[.frames[1:][].ms] | sort | .[1]' "$folder/$mode.$number.stats" > "$folder/$mode.$number"
  done
}
if [[ ${1:-} == --round ]]; then
  folder=$2
  round "${@:3}"
  exit
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for ((i = 1; i <= rounds; ++i)); do
  ${LOCK:-} "${BASH_SOURCE[0]}" "$rounds" --round "$folder" "$i" "$@"
done

printf '%-10s %10s %10s %10s   %s\n' granularity 'median ms' least most 'ratio (least to most)'
for mode in "${modes[@]}"; do
  for ((i = 1; i <= rounds; ++i)); do
    jq -n --slurpfile with "$folder/$mode.$i" --slurpfile without "$folder/none.$i" '[$with[0], $with[0] / $without[0]]'
  done | jq -rs --arg mode "$mode" 'def median: sort | if length % 2 == 1 then .[length / 2 | floor] else (.[length / 2] + .[length / 2 - 1]) / 2 end;
    map(.[0]) as $ms | map(.[1]) as $ratio
    | [$mode, ($ms | median), ($ms | min), ($ms | max), ($ratio | median), ($ratio | min), ($ratio | max)] | @tsv' |
    while IFS=$'\t' read -r name middle least most ratio low high; do
      printf '%-10s %10.1f %10.1f %10.1f   %.3f (%.3f to %.3f)\n' "$name" "$middle" "$least" "$most" "$ratio" "$low" "$high"
    done
done
