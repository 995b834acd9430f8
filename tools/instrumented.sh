# shellcheck shell=bash disable=SC2034
# Sourced by the tools that build with sanitizers or coverage, after setup.sh.

# llvm: its symbolizer makes the reports readable.
readonly clang_packages=(clang libclang-rt-dev llvm)

# -O1 and assertions: what sanitizers are made for.
readonly clang_address_options=(
    -DCMAKE_CXX_COMPILER=clang++ -DPOINTPLANE_SANITIZE=address -DPOINTPLANE_BUILD_FUZZERS=ON
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1)

readonly gcc_thread_options=(
    -DPOINTPLANE_SANITIZE=thread -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1)

# The tests of what runs in several threads.
readonly threaded_tests=(
    test_grabber test_grabber_OpenNi2Recording test_odometry test_mrpt_io test_apps_Odometry test_evaluation
    test_lab test_simulation_SimulateApp)

# OpenNI2, OpenCV, MRPT and the C++ library keep what they allocate once: no leaks of ours.
readonly sanitizer_options=allocator_may_return_null=1:detect_leaks=0

# configure_instrumented OPTION...: $source_dir in $build_dir
source_dir=.
configure_instrumented() {
    local launcher=()
    if command -v ccache >/dev/null; then
        launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    mkdir -p "$build_dir"
    cmake -S "$source_dir" -B "$build_dir" -G Ninja "${fast_build[@]}" "${launcher[@]}" "$@" >"$build_dir.log" ||
        die "cmake failed, see $build_dir.log"
}
