#!/usr/bin/env bash
# Writes the tables of docs/consistency.md: are the covariances true? Joint NEES per degree of
# freedom (1 = true, above = optimistic) of config.ini, also with points or planes alone and for cameras
# that move otherwise; and on the real sequences of the plain H^-1 of the propagated noise, and of
# config-paper.ini, which claims that.
# usage: POINTPLANE_DATA=DIR benchmarks/consistency_table.sh BUILD [RUNS_PER_SCENE]
set -euo pipefail
shopt -s inherit_errexit
readonly usage='usage: POINTPLANE_DATA=DIR benchmarks/consistency_table.sh BUILD [RUNS_PER_SCENE]'
build=$(realpath "${1:?$usage}")
runs=${2:-50}
data=$(realpath "${POINTPLANE_DATA:?POINTPLANE_DATA must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=$build/bin
ground_truth=$build/benchmarks/ground_truth/benchmark_ground_truth
source benchmarks/tables.sh
need_built "$bin"/pointplane-{convert,simulate,odometry,eval} "$ground_truth"

# options_of VARIANT: what it sets.
options_of() {
    case $1 in
    plain)
        printf '%s\n' --set Covariance.model=independent --set NoiseScale.adaptive=false \
            --set NoiseScale.pointFactor=1 --set NoiseScale.planeFactor=1 \
            --set Shutter.varianceFactor=1
        ;;
    points) printf '%s\n' --set Pipeline.usePlanes=false ;;
    planes) printf '%s\n' --set Pipeline.usePoints=false ;;
    esac
}

# estimate RAWLOG PREFIX VARIANT...: the poses of each variant, PREFIX.VARIANT.rawlog.
estimate() {
    local rawlog=$1 prefix=$2 variant options
    shift 2
    for variant; do
        mapfile -t options < <(options_of "$variant")
        quietly "$bin/pointplane-odometry" -c config.ini "$rawlog" --quiet --jobs 1 --only-poses \
            --since 31 -o "$prefix.$variant.rawlog" "${options[@]}"
    done
}

# nees GT EST [GT EST]... [OPTION]...: "1 frame / 10 frames / 1 s" of all runs together.
nees() {
    "$bin/pointplane-eval" nees "$@" --body-from-gt optical --csv - |
        awk -F, '$4 == "joint" {printf "%s%.2f", sep, $5; sep = " / "}'
}

# simulated_run SCENE SEED MOTION: leaves the poses of all variants and the ground truth in $work.
simulated_run() {
    local prefix=$work/$1.$3.$2 motion=() variants=(config) calibration
    mapfile -t calibration < <(calibration_errors)
    case $3 in
    hand) variants=(config points planes) ;;
    exact) calibration=() ;;
    fast) motion=(--set motionSpeed=2) ;;
    turning) motion=(--set motionTurnsOnly=true) ;;
    still) motion=(--set motionSpeed=0) ;;
    esac
    local work=$prefix # for the logs of this run
    mkdir "$work"
    quietly "$bin/pointplane-simulate" "$1" -o "$work/in.rawlog" --seed "$2" --duration 2 --quiet \
        "${calibration[@]}" "${motion[@]}"
    estimate "$work/in.rawlog" "$prefix" "${variants[@]}"
    mv "$work/in.groundtruth.txt" "$prefix.txt"
    rm -r "$work"
}

# simulated_cell SCENE MOTION VARIANT: of all runs.
simulated_cell() {
    local files=() poses
    for poses in "$work/$1.$2".*."$3.rawlog"; do
        files+=("${poses%."$3".rawlog}.txt" "$poses")
    done
    nees "${files[@]}"
}

# truth_noise SEQUENCE: x,y,z in degrees as measured one frame apart; 0,0,0 where truth is exact.
truth_noise() {
    case $1 in
    tum_*) awk -F, -v s="$1" '$1 == s && $2 == 1 {print $5 "," $6 "," $7}' "$work/noise.csv" ;;
    *) echo 0,0,0 ;;
    esac
}

real() { # folder
    local truth=$work/$1.groundtruth.txt noise options=() config plain paper
    noise=$(truth_noise "$1")
    [[ $noise == 0,0,0 ]] || options=(--gt-sigma-trans 0.0001 --gt-sigma-rot-deg "$noise")
    quietly "$bin/pointplane-convert" tum "$data/$1" -o "$work/$1.rawlog" --quiet
    estimate "$work/$1.rawlog" "$work/$1" config plain
    quietly "$bin/pointplane-odometry" -c config-paper.ini "$work/$1.rawlog" --quiet --jobs 1 \
        --only-poses --since 31 -o "$work/$1.paper.rawlog"
    [[ $noise != 0,0,0 ]] || noise=exact
    config=$(nees "$truth" "$work/$1.config.rawlog" "${options[@]}")
    plain=$(nees "$truth" "$work/$1.plain.rawlog" "${options[@]}")
    paper=$(nees "$truth" "$work/$1.paper.rawlog" "${options[@]}")
    echo "| $1 | ${noise//,/ / } | $config | $plain | $paper |"
}

readonly scenes=(corner desk room notexture cabinet corridor corridor_floor)
export bin work
export -f quietly options_of estimate nees calibration_errors simulated_run
for motion in hand exact fast turning still; do
    for scene in "${scenes[@]}"; do
        for ((seed = 1; seed <= runs; ++seed)); do
            echo "$scene $seed $motion"
        done
    done
done | xargs -P "$(nproc)" -L 1 bash -c '
    set -euo pipefail
    trap "((\$? == 0)) || exit 255" EXIT # at once, not after the other runs
    simulated_run "$@"' run

{
    echo "Noise of the ground truth's rotation per pose, about the camera's axes x / y / z [deg], from pairs one"
    echo "frame apart:"
    echo
    quietly "$ground_truth" --data "$data" --sequences tum_,icl_ --csv "$work/noise.csv"
    awk -F ' *[|] *' '/^[|]/ && ($3 == "frames apart" || $3 == "1" || $3 ~ /^-/) {
        print "| " $2 " | " $4 " | " $6 " | " $7 " |"
    }' "$work/log" # more frames apart: an upper bound
    echo
    echo "Joint NEES per degree of freedom over 1 frame / 10 frames / 1 s, with the ground truth's noise"
    echo "stated as 0.1 mm and what was measured one frame apart:"
    echo
    echo "| sequence | ground truth [deg] | config.ini | plain H⁻¹ | config-paper.ini |"
    echo "|---|---|---|---|---|"
    for folder in tum_fr1_xyz_part tum_fr1_rpy_part tum_fr3_structure_notexture_far_part \
        icl_living_room_kt0_part kinect1_fixed_person_part; do
        real "$folder"
    done
    echo
    echo "Simulated scenes, 2 s each, $runs seeds pooled. Each seed has a camera whose focal length, principal"
    echo "point and scale of depth are off, by what config.ini states; in the last column they are exact:"
    echo
    echo "| scene | config.ini | points alone | planes alone | config.ini, exact calibration |"
    echo "|---|---|---|---|---|"
    for scene in "${scenes[@]}"; do
        row="| $scene |"
        for variant in config points planes; do
            cell=$(simulated_cell "$scene" hand "$variant")
            row+=" $cell |"
        done
        cell=$(simulated_cell "$scene" exact config)
        echo "$row $cell |"
    done
    echo
    echo "The same scenes with config.ini, from cameras that move otherwise:"
    echo
    echo "| scene | twice as fast | turning in place | standing still |"
    echo "|---|---|---|---|"
    for scene in "${scenes[@]}"; do
        row="| $scene |"
        for motion in fast turning still; do
            cell=$(simulated_cell "$scene" "$motion" config)
            row+=" $cell |"
        done
        echo "$row"
    done
} >"$work/tables"
replace docs/consistency.md tables "$work/tables"
