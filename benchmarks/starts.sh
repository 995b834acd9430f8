#!/usr/bin/env bash
# Prints errors over a second from eight starting frames, three frames apart: of a camera that moves
# fast, one start says little.
# usage: POINTPLANE_DATA=DIR benchmarks/starts.sh BUILD [CONFIG] [OPTION of pointplane-odometry]...
set -euo pipefail
shopt -s inherit_errexit
readonly usage='usage: POINTPLANE_DATA=DIR benchmarks/starts.sh BUILD [CONFIG] [OPTION]...'
build=$(realpath "${1:?$usage}")
config=$(realpath "${2:-config.ini}")
shift "$(($# < 2 ? $# : 2))"
data=$(realpath "${POINTPLANE_DATA:?POINTPLANE_DATA must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=$build/bin
source benchmarks/tables.sh
need_built "$bin"/pointplane-{convert,odometry,eval}

# error SEQUENCE START [OPTION]...: translation [mm] and rotation [deg], RMSE.
error() {
    local name=$1 start=$2
    shift 2
    quietly "$bin/pointplane-odometry" -c "$config" "$work/$name.rawlog" --first "$start" --quiet \
        --jobs 1 --only-poses -o "$work/poses.rawlog" "$@"
    "$bin/pointplane-eval" rpe "$work/$name.groundtruth.txt" "$work/poses.rawlog" \
        --body-from-gt optical --fixed-delta --delta 1 --json - |
        awk -F'[:,]' '/"rmse"/ {v[++n] = $2} END {printf "%.2f %.3f\n", 1000 * v[1], v[2]}'
    rm "$work/poses.rawlog"
}

echo "| sequence | geometric mean [mm] | [deg] | worst [mm] | each start [mm] |"
echo "|---|---|---|---|---|"
for folder in "$data"/*/; do
    name=$(basename "$folder")
    [[ -e $folder/groundtruth.txt && -e $folder/depth.txt ]] || continue
    quietly "$bin/pointplane-convert" tum "$folder" -o "$work/$name.rawlog" --quiet
    for start in 0 3 6 9 12 15 18 21; do
        error "$name" "$start" "$@"
    done | awk -v name="$name" '
        {t += log($1); r += log($2); if ($1 > worst) worst = $1; all = all " " $1}
        END {printf "| %s | %.2f | %.3f | %.1f |%s |\n", name, exp(t / NR), exp(r / NR), worst, all}'
done
