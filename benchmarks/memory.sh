#!/usr/bin/env bash
# Peak memory of pointplane-odometry on a short and on a long simulated rawlog, as a Markdown table: is it flat?
# usage: benchmarks/memory.sh BIN_DIR [FRAMES]   (default 10000; needs about 1 MB of TMPDIR per frame)
set -euo pipefail
bin=$(realpath "${1:?usage: benchmarks/memory.sh BIN_DIR [FRAMES]}")
frames=${2:-10000}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

run() { # frames: a table line with the peak resident set [MB]
    "$bin/pointplane-simulate" corner -o "$work/in.rawlog" --duration "$((($1 + 29) / 30))" \
        --set exposure=0 --set antialias=false --quiet >/dev/null
    /usr/bin/time -f '%M' -o "$work/peak" "$bin/pointplane-odometry" -c config.ini "$work/in.rawlog" \
        -o "$work/poses.rawlog" --only-poses --quiet --trajectory "$work/poses.txt" >/dev/null
    echo "| $(grep -vc '^#' "$work/poses.txt") | $(($(cat "$work/peak") / 1024)) |"
}

echo "| frames | peak resident memory, MB |"
echo "|---|---|"
run 150
run "$frames"
