#!/usr/bin/env bash
# Fuzzes what reads foreign files, each target for the same time, one worker each, one after another.
#
#   tools/fuzz.sh [--seconds N] [TARGET…]       60 seconds a target; without targets, all of them
#
# Inputs that reach new code are kept in build-fuzz/corpus/TARGET, where the next run goes on; what crashes, hangs or takes too
# much memory goes to build-fuzz/findings/TARGET and ends that target's run. Exit status: 0 nothing was found; 1 something was.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root"

seconds=60 targets=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --seconds) seconds=${2:?--seconds needs a number} && shift ;;
    -*) sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done

tools/setup.sh fuzz
tools/build.sh --preset fuzz fuzz
[[ ${#targets[@]} -gt 0 ]] || mapfile -t targets < <(cd build-fuzz/bin && printf '%s\n' fuzz_* | sed 's/^fuzz_//')

found=0
for target in "${targets[@]}"; do
  corpus=build-fuzz/corpus/$target findings=build-fuzz/findings/$target dictionary=tests/fuzz/$target.dict
  mkdir -p "$corpus" "$findings"
  build-fuzz/bin/fuzz_"$target" --seeds "$corpus"
  arguments=(-max_total_time="$seconds" -timeout=20 -rss_limit_mb=2500 -malloc_limit_mb=512 -max_len=16384 -print_final_stats=1
             -artifact_prefix="$findings/")
  [[ ! -e $dictionary ]] || arguments+=(-dict="$dictionary")
  echo "fuzz: $target for $seconds s" >&2
  build-fuzz/bin/fuzz_"$target" "${arguments[@]}" "$corpus" || found=1
done
exit "$found"
