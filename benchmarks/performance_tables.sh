#!/usr/bin/env bash
# Writes the tables of docs/performance.md: time per frame beside the peers', time per stage, quality and time of the plane
# extraction, memory.
# usage: POINTPLANE_DATA=DIR benchmarks/performance_tables.sh BUILD [speed] [planes] [memory]   (default: all three)
set -euo pipefail
build=$(realpath "${1:?usage: POINTPLANE_DATA=DIR benchmarks/performance_tables.sh BUILD [speed] [planes] [memory]}")
shift
data=$(realpath "${POINTPLANE_DATA:?must name the folder with the sequences}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
page=docs/performance.md
parts=${*:-speed planes memory}

replace() { # section, file with the new text
    sed -i -e "/<!-- $1:begin -->/,/<!-- $1:end -->/{/$1:begin/{p;r $2
};/$1:end/p;d}" "$page"
}

for part in $parts; do
    case $part in
    speed)
        "$build/benchmarks/speed/benchmark_speed" --data "$data" --markdown "$page" >/dev/null
        ;;
    planes)
        { echo && "$build/benchmarks/planes/benchmark_planes" && echo; } >"$work/planes.md"
        replace planes "$work/planes.md"
        ;;
    memory)
        { echo && benchmarks/memory.sh "$build/bin" && echo; } >"$work/memory.md"
        replace memory "$work/memory.md"
        ;;
    *)
        echo "performance_tables.sh: unknown part '$part' (speed, planes, memory)" >&2
        exit 2
        ;;
    esac
done
