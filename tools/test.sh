#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. CI runs exactly this.
#
#   tools/test.sh [CTEST ARGUMENTS]       e.g. -R scan
#   MYRIAD_QUICK=1 tools/test.sh …        without the sanitised build
#
# Exit status: ctest's, or that of the sanitised tests if only these failed.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root" # where ctest looks for presets

tools/setup.sh test
tools/build.sh

# The host side under AddressSanitizer and UndefinedBehaviorSanitizer. First, so that the summary of all tests comes last.
sanitised=0
if [[ ${MYRIAD_QUICK:-} != 1 ]]; then
  tools/build.sh --preset asan myriad_scenes_tests myriad_tools_tests
  ctest --preset asan || sanitised=$?
  [[ $sanitised -eq 0 ]] || echo "test: the sanitised tests failed (above); now the others" >&2
fi

# The preset turns the validation layers on, and runs two tests at a time: a CPU device takes all cores, but much of a test is a driver that
# compiles on one.
ctest --preset validation "$@"
exit "$sanitised"
