#!/usr/bin/env bash
# Writes the pictures of README.md and the tutorials: an overlay, the path with its covariances, NEES over
# time, and, with the packages mrpt-apps and python3-numpy, the map of docs/tutorials/mrpt_slam.md. One minute.
# usage: POINTPLANE_DATA=DIR benchmarks/pictures.sh BIN_DIR
set -euo pipefail
bin=$(realpath "${1:?usage: POINTPLANE_DATA=DIR benchmarks/pictures.sh BIN_DIR}")
data=$(realpath "${POINTPLANE_DATA:?must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/tables.sh

quietly "$bin/pointplane-convert" tum "$data/tum_fr1_xyz_part" -o "$work/in.rawlog" --quiet
quietly "$bin/pointplane-odometry" -c config.ini "$work/in.rawlog" -o "$work/out.rawlog" --only-poses \
    --since 31 --overlay "$work/overlay" --quiet
quietly "$bin/pointplane-eval" nees "$work/in.groundtruth.txt" "$work/out.rawlog" \
    --body-from-gt optical --gt-sigma-trans 0.0001 --gt-sigma-rot-deg 0.089,0.057,0.045 \
    --report "$work/report"
cp "$work/overlay/000100.jpg" docs/figures/overlay.jpg
cp "$work/report/path-from-above.svg" docs/figures/path.svg
cp "$work/report/nees-of-increments-of-1-frame.svg" docs/figures/nees.svg

if command -v observations2map >/dev/null && /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    quietly "$bin/pointplane-simulate" room -o "$work/room.rawlog" --duration 3 --size 320x240 --quiet
    quietly "$bin/pointplane-odometry" "$work/room.rawlog" -o "$work/vo.rawlog" --format1 --with-points \
        --simplemap "$work/vo.simplemap" --quiet
    printf '[MappingApplication]\npointsMap_count = 1\n' >"$work/o2m.ini"
    quietly observations2map "$work/o2m.ini" "$work/vo.simplemap" "$work/map"
    benchmarks/map_picture.py "$work/map_mrpt__maps__CSimplePointsMap_00.txt" docs/figures/map.png
fi
