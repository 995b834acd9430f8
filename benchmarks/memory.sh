#!/usr/bin/env bash
# Peak memory of pointplane-odometry on a short and on a long rawlog, as a Markdown table: is it flat?
# usage: benchmarks/memory.sh BIN_DIR RAWLOG [FRAMES]   (RAWLOG is read over and over until so many frames, default 10000)
set -euo pipefail
bin=$(realpath "${1:?usage: benchmarks/memory.sh BIN_DIR RAWLOG [FRAMES]}")
rawlog=$(realpath "${2:?RAWLOG is missing}")
frames=${3:-10000}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Frames and peak resident set [MB] of one run over the rawlog, repeated so many times.
run() {
    local inputs=() i
    for ((i = 0; i < $1; ++i)); do inputs+=("$rawlog"); done
    /usr/bin/time -f '%M' -o "$work/peak" "$bin/pointplane-odometry" -c config.ini "${inputs[@]}" \
        -o "$work/poses.rawlog" --only-poses --quiet --trajectory "$work/poses.txt" >/dev/null
    echo "| $(grep -vc '^#' "$work/poses.txt") | $(($(cat "$work/peak") / 1024)) |"
}

echo "| frames | peak resident memory, MB |"
echo "|---|---|"
once=$(run 1)
echo "$once"
perRun=$(awk '{print $2}' <<<"$once")
run $(((frames + perRun - 1) / perRun))
