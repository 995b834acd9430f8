#!/usr/bin/env bash
# Writes the tables of docs/performance.md: time per frame beside the peers', time per stage, quality and time of the plane
# extraction, memory.
# usage: POINTPLANE_DATA=DIR benchmarks/performance_tables.sh BUILD [speed] [planes] [memory]   (default: all three)
set -euo pipefail
build=$(realpath "${1:?usage: POINTPLANE_DATA=DIR benchmarks/performance_tables.sh BUILD [speed] [planes] [memory]}")
shift
data=$(realpath "${POINTPLANE_DATA:?must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/tables.sh
page=docs/performance.md
parts=${*:-speed planes memory}

for part in $parts; do
    case $part in
    speed)
        "$build/benchmarks/speed/benchmark_speed" --data "$data" --markdown "$page" >/dev/null
        ;;
    planes)
        {
            echo
            "$build/benchmarks/planes/benchmark_planes"
            echo
        } >"$work/planes.md"
        replace "$page" planes "$work/planes.md"
        ;;
    memory)
        {
            echo
            benchmarks/memory.sh "$build/bin"
            echo
        } >"$work/memory.md"
        replace "$page" memory "$work/memory.md"
        ;;
    *)
        echo "performance_tables.sh: unknown part '$part' (speed, planes, memory)" >&2
        exit 2
        ;;
    esac
done
