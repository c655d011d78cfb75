#!/usr/bin/env bash
# From input to picture: flies through a scene under Xvfb, and tells how late previews were. Needs xvfb and xdotool; a machine with nothing else to do.
#
#   tools/view/latency.sh SCENE [options of myriad view]      MYRIAD=build/bin/myriad
set -euo pipefail
scene=$1; shift
work=$(mktemp -d)
log=$work/log
trap 'kill "${viewer:-}" "${screen:-}" 2>/dev/null || true; rm -rf "$work"' EXIT

Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
screen=$!
until [[ -s $work/display ]]; do sleep 0.1; done
DISPLAY=:$(<"$work/display")
export DISPLAY
"${MYRIAD:-build/bin/myriad}" view "$scene" --fresh --verbose --window 1280x720 "$@" 2>"$log" &
viewer=$!

# Waits for so many lines with such a text.
await() { until [[ $(grep -c "$2" "$log") -ge $1 ]]; do kill -0 "$viewer"; sleep 0.1; done; }
await 1 'preview.*wish'
window=$(xdotool search --name Myriad | head -1)
xdotool windowfocus "$window"
# Three times, for the size of previews follows what they took; the last one counts.
for round in 1 2 3; do
  sleep 2
  from=$(wc -l <"$log")
  xdotool keydown w; sleep 1.5; xdotool keyup w; xdotool keydown s; sleep 1.5; xdotool keyup s
done
sed -n "$((from + 1)),\$p" "$log" | sed -n 's/.*preview \([0-9x]*\) of wish .*, \([0-9]*\) ms, \([0-9]*\) ms after input/\1 \2 \3/p' | awk '$1 == size || !size { size = $1; print }' |
  sort -n -k3 | awk '{ size = $1; render[NR] = $2; late[NR] = $3 } END { if (!NR) exit 1; printf "previews %s: %d, rendered in %d ms, shown %d ms after input (median; the latest %d)\n", size, NR, render[int((NR + 1) / 2)], late[int((NR + 1) / 2)], late[NR] }'
