#!/usr/bin/env bash
# Writes the figures of docs/paper_figures.md and its pictures, by `pointplane-lab reproduce`. Less than 10
# minutes on 2 cores.
# usage: POINTPLANE_DATA=DIR benchmarks/paper_table.sh BIN_DIR   (BIN_DIR holds the pointplane programs)
set -euo pipefail
shopt -s inherit_errexit
bin=$(realpath "${1:?usage: POINTPLANE_DATA=DIR benchmarks/paper_table.sh BIN_DIR}")
data=$(realpath "${POINTPLANE_DATA:?POINTPLANE_DATA must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/tables.sh

# The paper's four sequences, whole or in part, and three that are not in it.
sequences=()
for folder in "$data"/*fr*1_desk{,_part} "$data"/*fr*1_360{,_part} \
    "$data"/*fr*3_structure_notexture_far{,_part} "$data"/*fr*3_cabinet{,_part} \
    "$data"/*fr*1_xyz{,_part} "$data"/*fr*1_rpy{,_part} "$data"/icl_living_room_kt0{,_part}; do
    [[ ! -e $folder/rgb.txt ]] || sequences+=("$folder")
done

"$bin/pointplane-lab" reproduce "${sequences[@]}" --paper-config config-paper.ini \
    --only tables,alpha,corner --figure docs/figures >"$work/figures.md"
{
    echo
    cat "$work/figures.md"
    echo
    for picture in docs/figures/paper_fig*.svg; do
        picture=${picture##*/}
        title=$(sed -E 's/^paper_fig([0-9])_(.*)[.]svg$/Fig. \1: \2/; y/_/ /' <<<"$picture")
        printf '![%s](figures/%s)\n\n' "$title" "$picture"
    done
} >"$work/page.md"
replace docs/paper_figures.md figures "$work/page.md"
