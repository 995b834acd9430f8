#!/usr/bin/env bash
# Same rawlog, same bytes: pointplane-odometry of build/release against itself, with other numbers of
# threads, without OpenCV's faster instruction sets, and against a debug build (or the builds that are
# named: tools/determinism.sh BUILD_DIR...).
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source tools/instrumented.sh

install_packages "${build_packages[@]}"
build pointplane-odometry pointplane-simulate
builds=("$@")
if ((${#builds[@]} == 0)); then
    say "building in build/debug"
    cmake -S . -B build/debug -G Ninja -DCMAKE_BUILD_TYPE=Debug >build/debug.log || die "cmake failed, see build/debug.log"
    cmake --build build/debug --parallel "$(num_jobs)" --target pointplane-odometry
    builds=(build/debug)
fi

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

# run_odometry NAME BUILD_DIR OPTION...: into $dir/NAME.*
run_odometry() {
    local name=$1 program=$2/bin/pointplane-odometry
    shift 2
    ASAN_OPTIONS=$sanitizer_options "$program" "$dir/in.rawlog" -o "$dir/$name.rawlog" \
        --trajectory "$dir/$name.txt" --quiet "$@" >/dev/null
}

different=0
for scene in desk corner; do
    "$build_dir/bin/pointplane-simulate" "$scene" -o "$dir/in.rawlog" --duration 2 --quiet >/dev/null
    run_odometry first "$build_dir" --jobs 1
    run_odometry again "$build_dir" --jobs 1
    run_odometry two_jobs "$build_dir" --jobs 2
    run_odometry two_threads "$build_dir" --jobs 3 --set Pipeline.numThreads=2
    OPENCV_CPU_DISABLE=AVX2,AVX,FMA3,FP16 run_odometry plain_cpu "$build_dir"
    names=(again two_jobs two_threads plain_cpu)
    for other in "${builds[@]}"; do
        run_odometry "${other//\//_}" "$other"
        names+=("${other//\//_}")
    done
    for name in "${names[@]}"; do
        verdict=same
        for kind in rawlog txt; do
            cmp -s "$dir/first.$kind" "$dir/$name.$kind" || { verdict=DIFFERENT; different=1; }
        done
        printf '%-10s %-12s %s\n' "$verdict" "$scene" "$name"
    done
done
exit "$different"
