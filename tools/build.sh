#!/usr/bin/env bash
# Builds Myriad, configuring first where that has not been done.
#
#   tools/build.sh [--preset default|debug|asan|fuzz] [--configure] [TARGET…]
#
# Without targets it builds everything; --configure stops before building. Presets: CMakePresets.json.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root"

preset=default configure_only="" targets=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --preset) preset=${2:?--preset needs a name} && shift ;;
    --configure) configure_only=yes ;;
    -*) sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done

build=build-$preset
[[ $preset != default ]] || build=build
has_line() { grep -qxF "$1" "$build/CMakeCache.txt" 2>/dev/null; }

arguments=()
# A cache that came along with a copied checkout names the old place, and CMake refuses it.
[[ ! -e $build/CMakeCache.txt ]] || has_line "CMAKE_HOME_DIRECTORY:INTERNAL=$root" || arguments+=(--fresh)
# A demo needs no Google Test; once it is there the tests are configured, and stay so.
tests=OFF
! pkg-config --exists gtest_main 2>/dev/null || tests=ON
if [[ ! -e $build/build.ninja || ${#arguments[@]} -gt 0 ]] || ! has_line "MYRIAD_TESTS:BOOL=$tests"; then
  cmake --preset "$preset" -DMYRIAD_TESTS=$tests --log-level=WARNING "${arguments[@]}" >/dev/null # errors come on stderr
fi

# From here on ninja itself notices changed CMake files and new sources.
[[ $configure_only ]] || cmake --build "$build" ${targets[0]+--target "${targets[@]}"}
