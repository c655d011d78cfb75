#!/usr/bin/env bash
# tools/fetch_corpus without a network: its own tables, and programs in place of apt-get, dpkg, npm, unzip and myriad that
# count how often they are asked. One line a failure; the exit status is their number.
set -uo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0
expect() { # WHAT COMMAND…: the command must succeed
  local what=$1
  shift
  "$@" || { echo "FAILED: $what: $*"; sed 's/^/    /' "$folder/err"; failures=$((failures + 1)); }
}
is() { [[ $1 == "$2" ]]; }
says() { grep -qF -- "$1" "$folder/err"; }
asked() { [[ $(grep -c "^$1" "$folder/asked" 2>/dev/null) == "$2" ]]; }

# A checkout with the script and small tables; the packages that the false registries have.
root=$folder/checkout bin=$folder/bin have=$folder/registry
mkdir -p "$root/tools/corpus" "$bin" "$have/deb/usr/share/x" "$have/npm/package/hdri" "$have/zip/maps"
cp "$source/tools/fetch_corpus" "$root/tools/"
echo "a mesh" >"$have/deb/usr/share/x/a b.obj"
echo "archive" >"$have/deb/usr/share/x/inner.pk3"
echo "not wanted" >"$have/deb/usr/share/x/other"
echo "a map" >"$have/zip/maps/m[1].bsp"
echo "export default 'data:application/exr;base64,$(printf 'v/1 pixels' | base64)'" >"$have/npm/package/hdri/sun.exr.js"
tar -C "$have/npm" -czf "$have/npm.tgz" package
cat >"$root/tools/corpus/packages" <<'END'
# a comment
debs  | apt | 1-1 | usr/share/x
@n/pm | npm | 2.0 | package/hdri
END
cat >"$root/tools/corpus/items" <<'END'
one  | debs        | one.json     |           | the first
two  | debs @n/pm  | debs/a b.obj | --unit cm | the second
hdri | @n/pm       | -            |           | environments
END
echo "A mesh | Somebody | CC0 | debs" >"$root/tools/corpus/licences"
hash() { printf '%s  %s\n' "$(sha256sum "$1" | cut -c1-64)" "$2"; }
{
  hash "$have/deb/usr/share/x/a b.obj" "debs/a b.obj"
  hash "$have/zip/maps/m[1].bsp" "debs/inner.pk3//maps/m[1].bsp"
  hash "$have/npm/package/hdri/sun.exr.js" "@n/pm/sun.exr.js"
} >"$root/tools/corpus/files.sha256"
echo '{}' >"$root/tools/corpus/one.json"

program() { printf '#!/bin/bash\necho "%s $*" >>"%s"\n%s\n' "$1" "$folder/asked" "$2" >"$bin/$1" && chmod +x "$bin/$1"; }
program apt-get '[[ ! -e '"$folder"'/offline ]] || exit 100; [[ ${!#} != *=* ]] || { [[ ! -e '"$folder"'/newer ]] || exit 100; }; touch debs.deb'
program dpkg 'mkdir -p "$3" && cp -r '"$have"'/deb/. "$3"'
program npm '[[ ! -e '"$folder"'/offline ]] || exit 1; [[ "$*" == *--ignore-scripts* ]] || exit 1; cp '"$have"'/npm.tgz n-pm-2.0.tgz'
program unzip 'cp -r '"$have"'/zip/. "$3"'
program myriad '[[ ! -e '"$folder"'/killed ]] || kill -9 $PPID; [[ ! -e '"$folder"'/term ]] || kill -TERM $PPID; [[ ! -e '"$folder"'/fail ]] || exit 2; echo "glb of ${@: -2:1}" >"${!#}"'

corpus=$folder/cache
run() { # STATUS ARGUMENTS…
  local wanted=$1 status
  shift
  PATH=$bin:$PATH MYRIAD=$bin/myriad MYRIAD_CORPUS=$corpus "$root/tools/fetch_corpus" "$@" >"$folder/out" 2>"$folder/err"
  status=$?
  expect "status of fetch_corpus $*" is "$status" "$wanted"
}
afresh() { rm -rf "$corpus" "$folder"/{asked,offline,newer,killed,term,fail}; }

# Everything, then nothing more: the second run asks nobody.
afresh
run 0
expect "the scenes" test -s "$corpus/one.glb" -a -s "$corpus/two.glb"
expect "a recipe lies beside the sources" is "$(cat "$corpus/one.glb")" "glb of $corpus/sources/one.json"
expect "a file of a package" is "$(cat "$corpus/two.glb")" "glb of $corpus/sources/debs/a b.obj"
expect "with the arguments of the table" grep -q "^myriad convert --quiet --unit cm " "$folder/asked"
expect "an environment" is "$(cat "$corpus/hdri/sun.exr")" "v/1 pixels"
expect "the licences" grep -q "by Somebody; CC0" "$corpus/LICENCES.txt"
expect "each package once" asked apt-get 1
expect "each package once" asked npm 1
expect "a file in an archive" is "$(cat "$corpus/sources/debs/inner.pk3/maps/m[1].bsp")" "a map"
expect "only what is used" test ! -e "$corpus/sources/debs/other"
expect "no work is left" is "$(cd "$corpus" && echo .work*)" ".work*"
touch "$folder/offline"
run 0
expect "nobody is asked" asked myriad 2
run 0 --check
run 0 --list
expect "the list" grep -qE "^two +there +the second" "$folder/out"
run 0 --licences
expect "the licences" grep -q "by Somebody; CC0" "$folder/out"

# One item needs only its packages.
afresh
run 0 one
expect "only what was asked for" test -s "$corpus/one.glb" -a ! -e "$corpus/two.glb"
expect "the other registry is not asked" asked npm 0

# A recipe that has changed makes its item again, and no other.
echo '{"new": 1}' >"$root/tools/corpus/one.json"
touch "$folder/offline"
run 0 one
expect "made again" asked myriad 2

# A table that has grown: the package is fetched again, and has all that is asked of it.
afresh
run 0 one
cp "$root/tools/corpus/files.sha256" "$folder/tables"
hash "$have/deb/usr/share/x/other" "debs/other" >>"$root/tools/corpus/files.sha256"
echo '{"new": 2}' >"$root/tools/corpus/one.json"
run 0 one
expect "what the table has now" test -f "$corpus/sources/debs/other"
expect "fetched again" asked apt-get 2
cp "$folder/tables" "$root/tools/corpus/files.sha256"

# Another version of a package will do if its files are the same.
afresh
touch "$folder/newer"
run 0 one
expect "asked for any version" asked apt-get 2

# What is not what it was is refused, and nothing of it stays.
afresh
echo "another mesh" >"$have/deb/usr/share/x/a b.obj"
run 2 one
expect "the file is named" says "a b.obj: FAILED"
expect "and the package" says "debs is not what it was"
expect "no package" test ! -e "$corpus/sources/debs"
expect "no scene" test ! -e "$corpus/one.glb"
rm "$have/deb/usr/share/x/a b.obj"
run 2 one
expect "a missing file is named" says "debs has no a b.obj"
echo "a mesh" >"$have/deb/usr/share/x/a b.obj"
run 0 one

# Offline at the start: one sentence; later it goes on.
afresh
touch "$folder/offline"
run 2
expect "it says why" says "cannot be downloaded; is there a network"
rm "$folder/offline"
run 0

# A program that fails, a signal, a sudden death: packages stay, half a scene does not, and the next run goes on from there.
for how in fail term killed; do
  afresh
  touch "$folder/$how"
  run "$(case $how in fail) echo 2 ;; term) echo 130 ;; killed) echo 137 ;; esac)" one
  expect "no scene after $how" test ! -e "$corpus/one.glb"
  expect "the package after $how" test -e "$corpus/sources/debs/a b.obj"
  rm "$folder/$how"
  touch "$folder/offline"
  run 0 one
  expect "the scene after $how" test -s "$corpus/one.glb"
  expect "no work is left after $how" is "$(cd "$corpus" && echo .work*)" ".work*"
done

# Damage is found, wherever it is.
for file in one.glb hdri/sun.exr "sources/debs/a b.obj"; do
  afresh
  run 0
  echo damage >>"$corpus/$file"
  run 1 --check
  expect "the damage is named" says "is damaged"
done

# Two at once do not get in each other's way.
afresh
for _ in 1 2 3; do
  PATH=$bin:$PATH MYRIAD=$bin/myriad MYRIAD_CORPUS=$corpus "$root/tools/fetch_corpus" >/dev/null 2>&1 &
done
wait
expect "each package once" asked apt-get 1
run 0 --check

# Bad usage.
run 2 three
expect "the items are named" says "there is no item 'three'; known: one two hdri"
run 2 --frobnicate
run 2 --list one
corpus=/proc/nowhere
run 2
expect "the folder is named" says "/proc/nowhere: the folder cannot be made"

# The real tables hang together.
root=$source corpus=$folder/none
run 0 --list
expect "no item is there" is "$(grep -c ' there ' "$folder/out")" 0
while IFS='|' read -r name packages from _; do
  for package in $packages; do
    expect "package of $name" grep -q "^$package " "$source/tools/corpus/packages"
    expect "files of $package" grep -q "  $package/" "$source/tools/corpus/files.sha256"
  done
  from=${from// /}
  expect "what $name is made from" test "$from" = - -o -s "$source/tools/corpus/$from" -o -n "$(sed 's|//|/|' "$source/tools/corpus/files.sha256" | grep -F "  $from")"
done < <(grep -v '^#' "$source/tools/corpus/items")
while IFS=: read -r recipe file; do
  expect "a file of ${recipe##*/}" grep -qF "  $file" <(sed 's|//|/|' "$source/tools/corpus/files.sha256")
done < <(grep -oE '"(file|texture)": "[^"]+"' "$source"/tools/corpus/*.json | sed -E 's/"(file|texture)": "(.*)"/\2/' | grep -v ':builtin:')
for recipe in "$source"/tools/corpus/*.json; do expect "a row of items" grep -qE "\| ${recipe##*/} " "$source/tools/corpus/items"; done
while IFS='|' read -r _ scene _; do
  scene=${scene// /}
  [[ $scene == builtin:* ]] || expect "an item of the gallery" grep -q "^${scene%.glb} " "$source/tools/corpus/items"
done < <(grep -v '^#' "$source/tools/corpus/gallery")

[[ $failures -eq 0 ]] && echo "all as expected"
exit "$failures"
