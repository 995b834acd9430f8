#!/usr/bin/env bash
# Writes the table of docs/cameras.md: the default configuration on simulated cameras of each kind.
# RPE over 1 s of exactly calibrated ones; joint NEES per degree of freedom over 1 frame / 10 frames /
# 1 s of ones whose calibration is off by what config.ini states. Seeds pooled.
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

# run KIND CAMERA SCENE MOTION_SCALE [OPTION]...: all seeds; with 0, the camera stands still. Leaves
# $work/KIND.SEED.*
run() {
    local kind=$1 camera=$2 scene=$3 motion=$4 seed prefix
    shift 4
    for ((seed = 1; seed <= seeds; ++seed)); do
        prefix=$work/$kind.$seed
        quietly "$bin/pointplane-simulate" "$scene" --camera "$camera" --seed "$seed" --duration 3 \
            --set "motionScale=$motion" --set "motionSpeed=$((motion > 0))" "$@" \
            -o "$prefix.rawlog" --quiet
        quietly "$bin/pointplane-odometry" "$prefix.rawlog" --jobs 1 --only-poses --since 31 \
            -o "$prefix.poses.rawlog" --quiet
    done
}

# row CAMERA SCENE MOTION_SCALE
row() {
    local scene=$2 seed files=() rpe nees noise
    run exact "$@"
    noise=$(sed -n 's/; surfaces count as bent .*//; s/^depth noise: //p' "$work/log")
    rpe=$(for ((seed = 1; seed <= seeds; ++seed)); do
        "$bin/pointplane-eval" rpe --fixed-delta --delta 1 --body-from-gt optical --csv - \
            "$work/exact.$seed.groundtruth.txt" "$work/exact.$seed.poses.rawlog"
    done | awk -F, '
        /,translation,m,/ {t += $(NF - 5) ^ 2; ++n}
        /,rotation,deg,/ {r += $(NF - 5) ^ 2}
        END {printf "%.1f / %.2f", 1000 * sqrt(t / n), sqrt(r / n)}')
    run off "$@" "${calibration[@]}"
    for ((seed = 1; seed <= seeds; ++seed)); do
        files+=("$work/off.$seed.groundtruth.txt" "$work/off.$seed.poses.rawlog")
    done
    nees=$("$bin/pointplane-eval" nees "${files[@]}" --body-from-gt optical --csv - |
        awk -F, '$4 == "joint" {printf "%s%.2f", sep, $5; sep = " / "}')
    [[ $3 != 0 ]] || scene="$scene, still"
    echo "| $1 | $scene | $rpe | $nees | $noise |"
}

mapfile -t calibration < <(calibration_errors)
{
    echo "| camera | scene | RPE, 1 s [mm / deg] | NEES, 1 frame / 10 frames / 1 s | depth noise learnt, last seed |"
    echo "|---|---|---|---|---|"
    for camera in kinect d435 azure phone; do
        row "$camera" corner 1
        row "$camera" desk 1
        row "$camera" desk 0
    done
} >"$work/table"
replace docs/cameras.md table "$work/table"
