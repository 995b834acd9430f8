#!/usr/bin/env bash
# Builds with sanitizers and runs the tests: tools/sanitize.sh address|thread [CTEST_ARGUMENT...]
#   address  address and undefined-behaviour sanitizers, Clang, all tests
#   thread   thread sanitizer, GCC, the tests of what runs in several threads
# In build folders of their own, build/sanitize-*.
kind=${1:-}
build_dir=build/sanitize-$kind
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source tools/instrumented.sh
shift || true

install_packages "${build_packages[@]}" "${test_packages[@]}"
case $kind in
    address)
        install_packages "${clang_packages[@]}"
        configure_instrumented "${clang_address_options[@]}" -DPOINTPLANE_TEST_TIMEOUT=1200
        build all
        export ASAN_OPTIONS=$sanitizer_options UBSAN_OPTIONS=print_stacktrace=1
        # Memory is watched, not time: what measures or bounds either belongs to ./test.
        excluded='Soak|consumer'
        ;;
    thread)
        configure_instrumented "${gcc_thread_options[@]}" -DPOINTPLANE_TEST_TIMEOUT=1200
        # Before the build, which asks the test programs for their tests.
        TSAN_OPTIONS="suppressions=$PWD/tools/tsan_suppressions.txt:halt_on_error=1:second_deadlock_stack=1"
        export TSAN_OPTIONS
        build "${threaded_tests[@]}"
        # Instrumented programs are too slow to keep up with a camera as these two demand.
        excluded='Soak|consumer|_NOT_BUILT$|^architecture/|unpluggingKeeps|odometryOnTheRecording'
        ;;
    *) die "usage: tools/sanitize.sh address|thread [CTEST_ARGUMENT...]" ;;
esac

say "running the tests with the $kind sanitizer"
ctest --test-dir "$build_dir" --parallel "$(num_jobs)" --no-tests=error --output-on-failure -E "$excluded" "$@"
