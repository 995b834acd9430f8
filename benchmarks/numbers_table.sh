#!/usr/bin/env bash
# Writes the last table of docs/consistency.md: what becomes of the covariances if a number of the
# error model is half or twice as large. Rows in which no figure changes by more than 0.1 are left out.
# usage: POINTPLANE_DATA=DIR benchmarks/numbers_table.sh BUILD
set -euo pipefail
shopt -s inherit_errexit
readonly usage='usage: POINTPLANE_DATA=DIR benchmarks/numbers_table.sh BUILD'
build=$(realpath "${1:?$usage}")
data=$(realpath "${POINTPLANE_DATA:?POINTPLANE_DATA must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=$build/bin
source benchmarks/tables.sh
need_built "$bin"/pointplane-{convert,odometry,eval}

# The noise of the ground truth is that of the first table of docs/consistency.md.
readonly sequences=(
    'tum_fr1_xyz_part 0.089,0.057,0.045' 'tum_fr1_rpy_part 0.103,0.161,0.055'
    'tum_fr3_structure_notexture_far_part 0.140,0.060,0.065' 'icl_living_room_kt0_part'
    'kinect1_fixed_person_part'
)
readonly keys=(
    Covariance.{noise,viewNoise,vignetting,principalPoint,focalLength,depthScale}
    NoiseScale.timeConstant MotionModel.accelerationTime
)

# value_of SECTION.KEY: what config.ini says.
value_of() {
    awk -F' = ' -v section="[${1%.*}]" -v key="${1#*.}" \
        '/^\[/ {here = $0 == section} here && $1 == key {split($2, v, " "); print v[1]}' config.ini
}

# cell SEQUENCE [NOISE] [OPTION]...: NEES over "1 frame / 1 s".
cell() {
    local name=$1 truth=()
    shift
    if [[ ${1:-} == 0.* ]]; then
        truth=(--gt-sigma-trans 0.0001 --gt-sigma-rot-deg "$1")
        shift
    fi
    quietly "$bin/pointplane-odometry" -c config.ini "$work/$name.rawlog" --quiet --jobs 1 \
        --only-poses --since 31 -o "$work/poses.rawlog" "$@"
    "$bin/pointplane-eval" nees "$work/$name.groundtruth.txt" "$work/poses.rawlog" \
        --body-from-gt optical --csv - "${truth[@]}" |
        awk -F, '$4 == "joint" {v[++n] = $5} END {printf "%.2f / %.2f", v[1], v[n]}'
    rm "$work/poses.rawlog"
}

# row NAME VALUE [OPTION]...: one cell a sequence.
row() {
    local out="| $1 | $2 |" sequence name_and_noise text
    shift 2
    for sequence in "${sequences[@]}"; do
        read -ra name_and_noise <<<"$sequence"
        text=$(cell "${name_and_noise[@]}" "$@")
        out+=" $text |"
    done
    echo "$out"
}

# changed_rows: the head of a table, its first row, and those in which a figure is off by more than 0.1.
changed_rows() {
    awk -F '|' '
        NR <= 2 { print; next }
        {
            isChanged = NR == 3
            for (i = 4; i < NF; ++i)
                for (k = split($i, v, "/"); k > 0; --k) {
                    if (NR == 3) first[i, k] = v[k]
                    isChanged = isChanged || v[k] - first[i, k] > 0.105 || first[i, k] - v[k] > 0.105
                }
            if (isChanged) print
        }'
}

for sequence in "${sequences[@]}"; do
    quietly "$bin/pointplane-convert" tum "$data/${sequence%% *}" -o "$work/${sequence%% *}.rawlog" --quiet
done
{
    echo "| number | value | fr1/xyz | fr1/rpy | fr3 | ICL | fixed Kinect |"
    echo "|---|---|---|---|---|---|---|"
    row "all as in config.ini" ""
    for key in "${keys[@]}"; do
        value=$(value_of "$key")
        for factor in 0.5 2; do
            changed=$(awk -v v="$value" -v f="$factor" 'BEGIN {printf "%g", v * f}')
            row "\`$key\`" "$changed" --set "$key=$changed"
        done
    done
} | changed_rows >"$work/table"
replace docs/consistency.md numbers "$work/table"
