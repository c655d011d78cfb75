#!/usr/bin/env bash
# What our tests read as valid glTF, and what our writer writes, is valid to Khronos' validator too.
#
#   tests/gltf_validator_test.sh SCENES_TESTS      the program with the tests of scenes/
#
# Exit status: 0 it is; 1 it is not; 77 the validator cannot be had.
set -euo pipefail

validate=$(cd "$(dirname "${BASH_SOURCE[0]}")/../tools" && pwd -P)/validate_gltf
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# The validator itself first: it must find what is wrong.
good='{"asset": {"version": "2.0"}}'
bad='{"asset": {"version": "2.0"}, "nodes": [{"mesh": 7}]}'
mkdir "$folder/probe"
expect() {
  local wanted=$1 status=0
  echo "$2" >"$folder/probe/probe.gltf"
  "$validate" "$folder/probe" >"$folder/log" || status=$?
  [[ $status -ne 77 ]] || exit 77
  [[ $status -eq $wanted ]] || { cat "$folder/log"; echo "validate_gltf ended with $status instead of $wanted on $2"; exit 1; }
}
expect 0 "$good"
expect 1 "$bad"

mkdir "$folder/kept"
MYRIAD_KEEP_GLB=$folder/kept "$1" --gtest_filter='Gltf*' --gtest_brief=1
"$validate" "$folder/kept" >"$folder/log" || { sed "s|$folder/kept/||" "$folder/log"; exit 1; }
tail -n 1 "$folder/log"
count=$(find "$folder/kept" -name '*.gl*' | wc -l)
[[ $count -ge 100 ]] || { echo "only $count files were kept; do the tests still keep them?"; exit 1; }
