#!/usr/bin/env bash
# Installs the Debian packages that Myriad needs and nothing that is already there.
#
#   tools/setup.sh                 what building and rendering need
#   tools/setup.sh test            what the tests need as well
#   tools/setup.sh corpus          what fetch_corpus and gallery need as well
#   tools/setup.sh fuzz            what tools/fuzz.sh needs as well
#   tools/setup.sh --upgrade-mesa  the same, and a newer Mesa from backports in place of an old one
#
# Exit status: 0 everything is there; 2 something is missing and may not be installed from here.
# Other scripts source it for mirror and mesa_version; then it does nothing by itself.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
backports_file=/etc/apt/sources.list.d/myriad-backports.sources

say() { echo "setup: $*" >&2; }
have() { command -v "$1" >/dev/null; }

# The names in the given sections of packages.txt.
packages() {
  awk -v sections=" $* " '/^\[/ { on = index(sections, " " substr($1, 2, length($1) - 2) " ") }
                          /^[a-z]/ && on { print $1 }' "$root/tools/packages.txt"
}

# Those of the given packages that are not installed.
missing() {
  comm -23 <(printf '%s\n' "$@" | sort -u) \
    <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p' | sort -u)
}

mesa_version() { dpkg-query -W -f '${db:Status-Status} ${Version}' mesa-vulkan-drivers 2>/dev/null | sed -n 's/^installed //p'; }

# Prints the kernel driver of a GPU that also has a Vulkan driver (ICD) of its own, and fails if there is none. A guess
# that only decides whether Mesa is needed; which device renders is for the program to choose.
hardware_gpu() {
  local node driver icd icds
  IFS=: read -ra icds <<<"${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}"
  [[ ${#icds[@]} -gt 0 ]] || icds=(/etc/vulkan/icd.d/*.json /usr/share/vulkan/icd.d/*.json)
  for node in /dev/nvidia0 /dev/dri/renderD*; do
    [[ -e $node ]] || continue
    driver=nvidia
    [[ $node == /dev/nvidia0 ]] || driver=$(basename "$(readlink -f "/sys/class/drm/${node##*/}/device/driver")")
    for icd in "${icds[@]}"; do
      [[ -e $icd ]] || continue
      case $driver:${icd##*/} in
        nvidia:nvidia* | nouveau:nouveau* | i915:intel* | xe:intel* | amdgpu:radeon* | amdgpu:amd*) echo "$driver" && return ;;
      esac
    done
  done
  return 1
}

# The address of the Debian archive that this machine already uses, so that a local mirror or proxy is respected.
mirror() {
  # shellcheck disable=SC2016 # apt's variables, not the shell's
  apt-get indextargets --format '$(CREATED_BY) $(RELEASE) $(CODENAME) $(SITE)' |
    awk -v suite="$VERSION_CODENAME" '$1 == "Packages" && ($2 == suite || $3 == suite) { site = $NF } END { print site }'
}

# Runs a command as root: as we are, or through sudo, which may ask for a password only where somebody can type it.
find_root() {
  as_root=()
  [[ $EUID -ne 0 ]] || return 0
  have sudo || return 1
  if sudo -n true 2>/dev/null; then as_root=(sudo -n)
  elif [[ -t 0 && -t 2 ]] && sudo -v; then as_root=(sudo)
  else return 1; fi
}

# apt-get as root: quiet unless it fails, and waiting for another apt to finish instead of giving up.
apt_get() {
  local log
  log=$(mktemp)
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q -o DPkg::Lock::Timeout=300 "$@" >"$log" 2>&1 ||
    { cat "$log" >&2; rm -f "$log"; return 1; }
  rm -f "$log"
}

# Prints backports' version of Mesa if it may be had. On Debian 12 it is 2 to 5 times faster than main's on our kernels;
# from Debian 13 on main itself is new enough. The suite changes nothing else: apt never prefers it unasked (pin 100).
backports_mesa() {
  [[ ${ID:-} == debian && $VERSION_CODENAME == bookworm ]] || return 1
  local uri suite=bookworm-backports
  if ! grep -Eqs "^[^#]*(bookworm|stable)-backports" /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources}; then
    uri=$(mirror) && [[ $uri ]] || return 1
    say "adding $suite ($uri) as $backports_file, for Mesa alone"
    printf '%s\n' "# Written by Myriad's tools/setup.sh, for a faster Mesa; may be removed." "Types: deb" "URIs: $uri" \
      "Suites: $suite" "Components: main" "Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg" |
      "${as_root[@]}" tee "$backports_file" >/dev/null
    # This file alone is fetched, and its failure is no failure of ours.
    apt_get update -o Dir::Etc::sourcelist="$backports_file" -o Dir::Etc::sourceparts=- -o APT::Get::List-Cleanup=0 2>/dev/null || true
  fi
  apt-cache madison mesa-vulkan-drivers | awk -v suite="$suite/" 'index($0, suite) { found = $3 } END { print found; exit !found }' ||
    { [[ ! ${uri:-} ]] || "${as_root[@]}" rm -f "$backports_file"; return 1; }
}

install_packages() {
  local names=("$@") version
  say "installing, with what they need: ${names[*]}"
  apt_get update || say "going on with the package lists that are there"
  if [[ " ${names[*]} " == *" mesa-vulkan-drivers "* ]] && version=$(backports_mesa) &&
    apt_get install --no-install-recommends -t bookworm-backports mesa-vulkan-drivers="$version"; then
    mapfile -t names < <(missing "${names[@]}")
  fi
  [[ ${#names[@]} -eq 0 ]] || apt_get install --no-install-recommends "${names[@]}"
}

# One line on what will render.
report_driver() {
  local version hint=""
  if [[ $gpu ]]; then
    say "Vulkan driver: the machine's own ($gpu)"
  elif version=$(mesa_version) && [[ $version ]]; then
    [[ $version != 22.* ]] || hint="; 25.0.7 is 2 to 5 times faster where backports offers it: tools/setup.sh --upgrade-mesa"
    say "Vulkan driver: Mesa $version (lavapipe, on the CPU$hint)"
  fi
}

# Without apt there is nothing to install with, but what CMake finds is good enough.
without_apt() {
  have cmake && have ninja && "$root/tools/build.sh" --configure >/dev/null 2>&1 && { say "no apt here, but CMake finds everything"; return; }
  say "no apt here; install the equivalents of these Debian packages, then run this again:"
  printf '  %s\n' "$@" >&2
  return 2
}

main() {
  local sections=(build run) upgrade="" wanted todo gpu version
  for argument in "$@"; do
    case $argument in
      test | corpus | fuzz) sections+=("$argument") ;;
      --upgrade-mesa) upgrade=yes ;;
      *) sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; return 2 ;;
    esac
  done
  mapfile -t wanted < <(packages "${sections[@]}")
  gpu=$(hardware_gpu) || gpu=""
  [[ ! $gpu ]] || mapfile -t wanted < <(printf '%s\n' "${wanted[@]}" | grep -vx mesa-vulkan-drivers)

  ! have npm || mapfile -t wanted < <(printf '%s\n' "${wanted[@]}" | grep -vx npm)

  if ! have apt-get || ! have dpkg-query; then
    without_apt "${wanted[@]}"
    return
  fi
  mapfile -t todo < <(missing "${wanted[@]}")
  [[ ! $upgrade || $gpu || " ${todo[*]} " == *" mesa-vulkan-drivers "* ]] || todo+=(mesa-vulkan-drivers)
  if [[ ${#todo[@]} -eq 0 ]]; then
    say "all ${#wanted[@]} packages are there"
  elif find_root; then
    install_packages "${todo[@]}"
  else
    say "${#todo[@]} packages are missing, and without root or sudo they cannot be installed from here:"
    printf '  %s\n' "${todo[@]}" >&2
    say "as root, run:  apt-get update && apt-get install -y --no-install-recommends ${todo[*]}"
    return 2
  fi
  report_driver
}

VERSION_CODENAME=""
# shellcheck source=/dev/null
[[ ! -e /etc/os-release ]] || . /etc/os-release
[[ ${BASH_SOURCE[0]} != "$0" ]] || main "$@"
