#!/usr/bin/env bash
# Writes the table of docs/cameras.md: the default configuration on simulated cameras of each kind.
# RPE over 1 s and joint NEES per degree of freedom over 1 frame / 10 frames / 1 s, seeds pooled.
# usage: benchmarks/cameras_table.sh BUILD [SEEDS]
set -euo pipefail
shopt -s inherit_errexit
readonly usage='usage: benchmarks/cameras_table.sh BUILD [SEEDS]'
build=$(realpath "${1:?$usage}")
seeds=${2:-3}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=$build/bin
source benchmarks/tables.sh
need_built "$bin"/pointplane-{simulate,odometry,eval}

# row CAMERA SCENE MOTION_SCALE: of all seeds. With 0, the camera stands still.
row() {
    local camera=$1 scene=$2 motion=$3 seed prefix files=() rpe nees noise
    for ((seed = 1; seed <= seeds; ++seed)); do
        prefix=$work/$seed
        quietly "$bin/pointplane-simulate" "$scene" --camera "$camera" --seed "$seed" --duration 3 \
            --set "motionScale=$motion" --set "motionSpeed=$((motion > 0))" \
            -o "$prefix.rawlog" --quiet
        quietly "$bin/pointplane-odometry" "$prefix.rawlog" --jobs 1 --only-poses --since 31 \
            -o "$prefix.poses.rawlog" --quiet
        noise=$(sed -n 's/^depth noise: //p' "$work/log")
        files+=("$prefix.groundtruth.txt" "$prefix.poses.rawlog")
    done
    rpe=$(for ((seed = 1; seed <= seeds; ++seed)); do
        "$bin/pointplane-eval" rpe --fixed-delta --delta 1 --body-from-gt optical --csv - \
            "$work/$seed.groundtruth.txt" "$work/$seed.poses.rawlog"
    done | awk -F, '
        /,translation,m,/ {t += $(NF - 5) ^ 2; ++n}
        /,rotation,deg,/ {r += $(NF - 5) ^ 2}
        END {printf "%.1f mm, %.2f deg", 1000 * sqrt(t / n), sqrt(r / n)}')
    nees=$("$bin/pointplane-eval" nees "${files[@]}" --body-from-gt optical --csv - |
        awk -F, '$4 == "joint" {printf "%s%.2f", sep, $5; sep = " / "}')
    [[ $motion != 0 ]] || scene="$scene, still"
    echo "| $camera | $scene | $rpe | $nees | $noise |"
}

{
    echo "| camera | scene | RPE, 1 s | NEES, 1 frame / 10 frames / 1 s | depth noise as learnt |"
    echo "|---|---|---|---|---|"
    for camera in kinect d435 azure phone; do
        row "$camera" corner 1
        row "$camera" desk 1
        row "$camera" desk 0
    done
} >"$work/table"
replace docs/cameras.md table "$work/table"
