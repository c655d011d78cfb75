#!/usr/bin/env bash
# From a bare machine to a picture: installs what is missing, builds, renders the atrium to out/.
#
#   tools/demo.sh [RENDER ARGUMENTS]      e.g. --size 320x180; build/bin/myriad render -h lists them
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
out=$root/out

"$root/tools/setup.sh"
"$root/tools/build.sh" myriad
mkdir -p "$out"
"$root/build/bin/myriad" render builtin:atrium -o "$out/atrium.exr" --png "$out/atrium.png" --stats "$out/atrium.json" "$@"

du -h --apparent-size "$out"/atrium.{png,exr,json}
echo "$SECONDS s in all"
