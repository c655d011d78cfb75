#!/usr/bin/env bash
# Runs the tests on both versions of Mesa that Debian 12 has. One of them is usually installed; the other is downloaded,
# unpacked beside and chosen by environment variables: the system is not touched, and no root is needed.
#
#   tools/test_mesa_versions.sh [CTEST ARGUMENTS]
#   tools/test_mesa_versions.sh --run VERSION -- COMMAND…     any command on one version, e.g. --run 22.3.6 -- vulkaninfo --summary
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
# shellcheck source=/dev/null # for mirror and mesa_version
. "$root/tools/setup.sh"
cache=${XDG_CACHE_HOME:-$HOME/.cache}/myriad
versions=(22.3.6 25.0.7)

# apt with lists and sources of its own, but the machine's package status: it knows what is installed and changes nothing.
private_apt() {
  local program=$1
  shift
  "$program" -q -o Dir::Etc::sourcelist="$cache/apt/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State="$cache/apt/state" \
    -o Dir::State::status=/var/lib/dpkg/status -o Dir::Cache="$cache/apt/cache" -o APT::Sandbox::User="$(id -un)" "$@"
}

# Downloads Mesa $1 and whatever apt would have to install with it here, and unpacks all of it to $2.
unpack() {
  local version=$1 to=$2 full uri packages library
  uri=$(mirror)
  mkdir -p "$cache"/apt/{state,cache}
  printf "deb ${uri:-http://deb.debian.org/debian} %s main\n" bookworm bookworm-backports >"$cache/apt/sources.list"
  private_apt apt-get update >&2
  full=$(private_apt apt-cache madison mesa-vulkan-drivers | awk -v v="$version-" 'index($3, v) == 1 { full = $3 } END { print full }')
  [[ $full ]] || { echo "Mesa $version: not offered by $uri" >&2; return 1; }
  # A dry run lists "Inst NAME [OLD] (NEW …": the driver and the libraries that are absent or too old here.
  mapfile -t packages < <(private_apt apt-get install -s --no-install-recommends --allow-downgrades -t bookworm-backports \
    mesa-vulkan-drivers="$full" | sed -nE 's/^Inst ([^ ]+) (\[[^]]*\] )?\(([^ ]+) .*/\1=\3/p')
  rm -rf "$to.part" && mkdir -p "$to.part/deb"
  (cd "$to.part/deb" && private_apt apt-get download "${packages[@]}" >&2)
  for deb in "$to.part"/deb/*.deb; do dpkg -x "$deb" "$to.part"; done
  library=$(cd "$to.part" && echo usr/lib/*/libvulkan_lvp.so)
  printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s", "api_version": "1.3.0"}}\n' "$to/$library" >"$to.part/lvp_icd.json"
  rm -rf "$to.part/deb" "$to" && mv "$to.part" "$to" # whole or not at all
}

# Makes Mesa $1 the only Vulkan driver of this process and its children.
use() {
  local version=$1 icd library to=$cache/mesa-$1
  if [[ $(mesa_version) == "$version"-* ]]; then
    icd=$(echo /usr/share/vulkan/icd.d/lvp_icd*.json)
  else
    [[ -d $to ]] || unpack "$version" "$to"
    icd=$to/lvp_icd.json
    library=$(echo "$to"/usr/lib/*/libvulkan_lvp.so)
    export LD_LIBRARY_PATH=${library%/*}${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
  fi
  export VK_DRIVER_FILES=$icd VK_ICD_FILENAMES=$icd      # the second name is for loaders before 1.3.207
  export MESA_SHADER_CACHE_DIR=$cache/shaders-$version   # so that no version sees the other's kernels
  mkdir -p "$MESA_SHADER_CACHE_DIR"
}

if [[ ${1:-} == --run ]]; then
  [[ $# -ge 4 && $3 == -- ]] || { echo "usage: $0 --run VERSION -- COMMAND…" >&2; exit 2; }
  use "$2"
  exec "${@:4}"
fi

"$root/tools/setup.sh" test
"$root/tools/build.sh"
cd "$root" # where ctest looks for presets
failed=()
for version in "${versions[@]}"; do
  echo "== Mesa $version"
  # The sanitised tests are about the host and not repeated here.
  tools/test_mesa_versions.sh --run "$version" -- build/bin/myriad info &&
    tools/test_mesa_versions.sh --run "$version" -- ctest --preset validation "$@" || failed+=("$version")
done
[[ ${#failed[@]} -eq 0 ]] || { echo "failed on Mesa ${failed[*]}" >&2; exit 1; }
echo "passed on Mesa ${versions[*]}"
