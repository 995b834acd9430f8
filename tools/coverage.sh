#!/usr/bin/env bash
# Line coverage of libs/ by all tests: a table, out/coverage.html, and failure below 90 %.
build_dir=build/coverage
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source tools/instrumented.sh
readonly least_percent=90

install_packages "${build_packages[@]}" "${test_packages[@]}" gcovr
configure_instrumented -DPOINTPLANE_COVERAGE=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1 \
    -DPOINTPLANE_TEST_TIMEOUT=1200
build all
find "$build_dir" -name '*.gcda' -delete

say "running the tests"
# Programs that are killed write no counts, and the consumer is built without counters.
ctest --test-dir "$build_dir" --parallel "$(num_jobs)" --no-tests=error --output-on-failure \
    -E 'Soak|consumer' "$@" || die "tests failed: coverage says nothing"

say "coverage of libs/"
mkdir -p out
gcovr --root . --object-directory "$build_dir" --filter 'libs/' --exclude-throw-branches \
    --exclude-unreachable-branches -j "$(num_jobs)" --html out/coverage.html --txt - \
    --fail-under-line "$least_percent"
