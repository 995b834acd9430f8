#!/usr/bin/env bash
# Writes the tables of docs/accuracy.md, our configurations and the peers on the sequences in
# POINTPLANE_DATA and on simulated scenes, and from them the results of README.md.
# usage: POINTPLANE_DATA=DIR benchmarks/accuracy_table.sh BUILD [options of benchmark_accuracy]
set -euo pipefail
build=$(realpath "${1:?usage: POINTPLANE_DATA=DIR benchmarks/accuracy_table.sh BUILD [options]}")
shift
: "${POINTPLANE_DATA:?must name the folder with the sequences}"
data=$(realpath "$POINTPLANE_DATA")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
"$build/benchmarks/accuracy/benchmark_accuracy" --data "$data" --markdown docs/accuracy.md "$@" >/dev/null
benchmarks/readme_results.sh
