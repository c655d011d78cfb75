#!/usr/bin/env bash
# Switches a configuration of Vulkan layers on for all programs of this user, as vkconfig does, or for one command.
#
#   tools/vkconfig/use.sh list                        their names
#   tools/vkconfig/use.sh NAME                        on, until it is switched off
#   tools/vkconfig/use.sh off
#   tools/vkconfig/use.sh run NAME COMMAND…           for this command alone
#
# Two files are what the loader and the layers read, below $XDG_DATA_HOME (~/.local/share):
#   vulkan/implicit_layer.d/VkLayer_override.json     which layers, with VK_LAYER_LUNARG_override
#   vulkan/settings.d/vk_layer_settings.txt           their settings
# Those of vkconfig itself are not touched: close it, or clear its override, first. LAYERS is the folder of the profiling layer
# where it is not build/layers.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
data=${XDG_DATA_HOME:-$HOME/.local/share}
layers=${LAYERS:-$here/../../build/layers}

fail() {
  echo "use.sh: $1" >&2
  exit 2
}

names() { for folder in "$here"/*/; do basename "$folder"; done; }

# Writes the two files below a folder.
put() {
  local name=$1 data=$2
  [[ -n $name && -f $here/$name/VkLayer_override.json ]] || fail "there is no configuration \"$name\"; there are: $(names | paste -sd ' ')"
  if grep -q @LAYERS@ "$here/$name/VkLayer_override.json"; then
    [[ -f $layers/VkLayer_myriad_profiler.json ]] || fail "the profiling layer is not in $layers; build it with tools/build.sh, or set LAYERS"
    layers=$(cd "$layers" && pwd -P)
  fi
  mkdir -p "$data/vulkan/implicit_layer.d" "$data/vulkan/settings.d"
  sed "s|@LAYERS@|$layers|" "$here/$name/VkLayer_override.json" > "$data/vulkan/implicit_layer.d/VkLayer_override.json"
  cp "$here/$name/vk_layer_settings.txt" "$data/vulkan/settings.d/vk_layer_settings.txt"
}

# Settings that this script wrote begin with its mark.
ours() { head -n 1 "$data/vulkan/settings.d/vk_layer_settings.txt" 2> /dev/null | grep -q '^# Myriad, tools/vkconfig/'; }

free() {
  local file
  for file in implicit_layer.d/VkLayer_override.json settings.d/vk_layer_settings.txt; do
    [[ ! -e $data/vulkan/$file ]] || ours || fail "$data/vulkan/$file is someone else's, vkconfig's perhaps; clear its override first"
  done
}

case ${1:-} in
  "" | -h | --help) sed -n '2,/^set/{/^#/s/^# \?//p}' "${BASH_SOURCE[0]}" ;;
  list) names ;;
  off)
    free
    rm -f "$data/vulkan/implicit_layer.d/VkLayer_override.json" "$data/vulkan/settings.d/vk_layer_settings.txt"
    ;;
  run)
    [[ $# -ge 3 ]] || fail "run needs a configuration and a command"
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    put "$2" "$folder"
    XDG_DATA_HOME=$folder "${@:3}"
    ;;
  *)
    [[ $# -eq 1 ]] || fail "one configuration at a time; for a command: run $1 COMMAND"
    free
    put "$1" "$data"
    ;;
esac
