#!/usr/bin/env bash
# Writes the tables of docs/consistency.md: are the covariances true? Joint NEES per degree of
# freedom (1 = true, above = optimistic) of config.ini and of the plain H^-1 of the propagated noise.
# usage: POINTPLANE_DATA=DIR benchmarks/consistency_table.sh BIN_DIR [RUNS_PER_SCENE]
set -euo pipefail
shopt -s inherit_errexit
readonly usage='usage: POINTPLANE_DATA=DIR benchmarks/consistency_table.sh BIN_DIR [RUNS_PER_SCENE]'
bin=$(realpath "${1:?$usage}")
runs=${2:-50}
data=$(realpath "${POINTPLANE_DATA:?POINTPLANE_DATA must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
source benchmarks/quietly.sh

plain=(--set NoiseScale.adaptive=false --set NoiseScale.pointFactor=1
    --set NoiseScale.planeFactor=1 --set Shutter.varianceFactor=1)

# nees RAWLOG TRUTH EVAL_OPTIONS -- [--set ...]: 1 frame, 10 frames, 1 s; nothing where a frame was
# only predicted, after which the covariance of a pose shrinks again
nees() {
    local rawlog=$1 truth=$2 options=()
    shift 2
    while [[ $1 != -- ]]; do
        options+=("$1")
        shift
    done
    shift
    quietly "$bin/pointplane-odometry" -c config.ini "$rawlog" --quiet --only-poses \
        -o "$work/poses.rawlog" "$@"
    "$bin/pointplane-eval" nees "$truth" "$work/poses.rawlog" --body-from-gt optical --csv - \
        "${options[@]}" 2>"$work/log" |
        awk -F, '$4 == "joint" {printf "%s%s", sep, $5; sep = " "}' || true
}

# Lines of "a b c" to one cell with their averages.
average() {
    awk 'NF == 3 {for (k = 1; k <= 3; ++k) sum[k] += $k; ++n}
         END {if (n) printf "%.2f / %.2f / %.2f", sum[1] / n, sum[2] / n, sum[3] / n
              else printf "-"
              if (n < NR) printf " (%d of %d)", n, NR}'
}

real() { # folder, eval options
    local folder=$1 ours h_inverse
    shift
    quietly "$bin/pointplane-convert" tum "$data/$folder" -o "$work/in.rawlog" --quiet
    ours=$(nees "$work/in.rawlog" "$work/in.groundtruth.txt" "$@" -- | average)
    h_inverse=$(nees "$work/in.rawlog" "$work/in.groundtruth.txt" "$@" -- "${plain[@]}" | average)
    rm -rf "$work"/in*
    echo "| $folder | $ours | $h_inverse |"
}

simulated() { # scene
    local scene=$1 seed ours=() h_inverse=()
    for ((seed = 1; seed <= runs; ++seed)); do
        quietly "$bin/pointplane-simulate" "$scene" -o "$work/in.rawlog" --seed "$seed" \
            --duration 3 --quiet
        ours+=("$(nees "$work/in.rawlog" "$work/in.groundtruth.txt" --)")
        h_inverse+=("$(nees "$work/in.rawlog" "$work/in.groundtruth.txt" -- "${plain[@]}")")
        rm -rf "$work"/in*
    done
    echo "| $scene | $(printf '%s\n' "${ours[@]}" | average) |" \
        "$(printf '%s\n' "${h_inverse[@]}" | average) |"
}

{
    echo "Joint NEES per degree of freedom over 1 frame / 10 frames / 1 s."
    echo
    echo "| sequence | config.ini | plain H⁻¹ |"
    echo "|---|---|---|"
    mocap=(--gt-sigma-trans 0.0001 --gt-sigma-rot-deg)
    real tum_fr1_xyz_part "${mocap[@]}" 0.06
    real tum_fr3_structure_notexture_far_part "${mocap[@]}" 0.06
    real icl_living_room_kt0_part
    echo
    echo "The Kinect's with 0.085 deg of ground-truth noise instead of 0.06:"
    echo
    echo "| sequence | config.ini | plain H⁻¹ |"
    echo "|---|---|---|"
    real tum_fr1_xyz_part "${mocap[@]}" 0.085
    real tum_fr3_structure_notexture_far_part "${mocap[@]}" 0.085
    echo
    echo "Simulated scenes, 3 s each, average over $runs seeds:"
    echo
    echo "| scene | config.ini | plain H⁻¹ |"
    echo "|---|---|---|"
    for scene in corner desk notexture cabinet corridor; do
        simulated "$scene"
    done
} >"$work/tables"
sed -i -e "/^<!-- tables begin -->$/,/^<!-- tables end -->$/{/^<!-- tables begin -->$/{p;r $work/tables
};/^<!-- tables end -->$/p;d}" docs/consistency.md
