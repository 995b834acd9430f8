#!/usr/bin/env bash
# Writes docs/paper_figures.md and the results of README.md: the paper's comparisons on the real
# sequences and on the simulated corner. 10 minutes on 2 cores.
# usage: POINTPLANE_DATA=DIR benchmarks/paper_table.sh BIN_DIR   (BIN_DIR holds the pointplane programs)
set -euo pipefail
shopt -s inherit_errexit
bin=$(realpath "${1:?usage: POINTPLANE_DATA=DIR benchmarks/paper_table.sh BIN_DIR}")
data=$(realpath "${POINTPLANE_DATA:?POINTPLANE_DATA must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
source benchmarks/quietly.sh

# RMSE of translation [mm] and rotation [deg] of the table that pointplane-eval prints.
rpe() {
    "$bin/pointplane-eval" rpe "$1" "$2" --fixed-delta --delta 1 |
        awk '/^translation/ {t = $3} /^rotation/ {r = $3} END {printf "%.1f / %.2f", 1000 * t, r}'
}

# run RAWLOG TRUTH CONFIG [--set ...]: one table cell.
run() {
    local rawlog=$1 truth=$2 config=$3
    shift 3
    quietly "$bin/pointplane-odometry" -c "$config" "$rawlog" --quiet \
        --trajectory "$work/out.txt" "$@"
    rpe "$truth" "$work/out.txt"
}

sequences=(tum_fr1_xyz_part tum_fr3_structure_notexture_far_part icl_living_room_kt0_part)
for s in "${sequences[@]}"; do
    quietly "$bin/pointplane-convert" tum "$data/$s" -o "$work/$s.rawlog" --quiet
done

row() { # title, config, options: a line over all sequences
    local title=$1 config=$2 line
    shift 2
    line="| $title |"
    for s in "${sequences[@]}"; do
        line+=" $(run "$work/$s.rawlog" "$work/$s.groundtruth.txt" "$config" "$@") |"
    done
    echo "$line"
}

quietly "$bin/pointplane-simulate" corner -o "$work/corner.rawlog" --duration 18 --quiet
final() { # options: distance of the last position from the truth [mm] and RPE
    local cell
    cell=$(run "$work/corner.rawlog" "$work/corner.groundtruth.txt" config.ini "$@")
    # Both trajectories are expressed in their first pose before the ends are compared.
    awk '
        function rel(a, b, out,   x, y, z) {  # position of b in frame a
            x = b[2] - a[2]; y = b[3] - a[3]; z = b[4] - a[4]
            rotate(-a[5], -a[6], -a[7], a[8], x, y, z, out)
        }
        function rotate(qx, qy, qz, qw, x, y, z, out,   tx, ty, tz) {
            tx = 2 * (qy * z - qz * y); ty = 2 * (qz * x - qx * z); tz = 2 * (qx * y - qy * x)
            out[1] = x + qw * tx + qy * tz - qz * ty
            out[2] = y + qw * ty + qz * tx - qx * tz
            out[3] = z + qw * tz + qx * ty - qy * tx
        }
        /^#/ {next}
        FNR == NR {truth[$1] = $0; next}
        ($1 in truth) || nearest($1) {
            split(key == "" ? truth[$1] : truth[key], g); split($0, e); key = ""
            if (!started) {split($0, e0); for (i in g) g0[i] = g[i]; started = 1}
        }
        function nearest(t,   k, d, best) {
            best = 0.005; key = ""
            for (k in truth) {d = k - t; if (d < 0) d = -d; if (d < best) {best = d; key = k}}
            return key != ""
        }
        END {
            rel(g0, g, a); rel(e0, e, b)
            printf "%.1f", 1000 * sqrt((a[1] - b[1])^2 + (a[2] - b[2])^2 + (a[3] - b[3])^2)
        }' "$work/corner.groundtruth.txt" "$work/out.txt"
    echo " | $cell"
}

{
    echo "# The paper's comparisons"
    echo
    echo "Written by \`benchmarks/paper_table.sh\`; do not edit. RPE is the RMSE over 1 s (TUM protocol,"
    echo "\`pointplane-eval rpe --fixed-delta --delta 1\`), translation mm / rotation deg. The sequences are"
    echo "parts: 12 s of fr1/xyz, 5 s of fr3/structure_notexture_far and 5 s of ICL-NUIM living room kt0."
    echo
    echo "| | fr1/xyz | fr3/structure_notexture_far | ICL kt0 |"
    echo "|---|---|---|---|"
    row "**config.ini**" config.ini
    row "config.ini, points alone" config.ini --set Pipeline.usePlanes=false
    row "config.ini, points alone, unweighted" config.ini \
        --set Pipeline.usePlanes=false --set PoseSolver.weighting=none
    row "config.ini, planes alone" config.ini --set Pipeline.usePoints=false
    row "config.ini, frame to frame" config.ini --set Reference.reference=previous
    row "config-fast.ini" config-fast.ini
    row "**config-paper.ini**" config-paper.ini
    row "config-paper.ini, unweighted" config-paper.ini --set PoseSolver.weighting=none
    row "config-paper.ini, points alone" config-paper.ini --set Pipeline.usePlanes=false
    row "config-paper.ini, points alone, unweighted" config-paper.ini \
        --set Pipeline.usePlanes=false --set PoseSolver.weighting=none
    echo
    echo "Simulated room corner (\`pointplane-simulate corner\`, 18 s, the paper's Fig. 5; the paper reports a"
    echo "final error of 114 mm for planes):"
    echo
    echo "| config.ini | final position error, mm | RPE |"
    echo "|---|---|---|"
    cells=$(final --set Pipeline.usePoints=false)
    echo "| planes alone | $cells |"
    cells=$(final)
    echo "| points and planes | $cells |"
} >"$work/paper_figures.md"
mv "$work/paper_figures.md" docs/paper_figures.md

# The README shows the three configurations.
if [[ $(grep -cE '<!-- results:(begin|end) -->' README.md) != 2 ]]; then
    echo "error: README.md has lost its lines results:begin and results:end" >&2
    exit 1
fi
{
    echo
    grep -m 2 '^|' docs/paper_figures.md
    grep -E '^\| \**config(-fast|-paper)?\.ini\** \|' docs/paper_figures.md | grep -v final | tr -d '*'
    echo
} >"$work/results.md"
sed -i -e "/<!-- results:begin -->/,/<!-- results:end -->/{/results:begin/{p;r $work/results.md
};/results:end/p;d}" README.md
