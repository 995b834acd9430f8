#!/usr/bin/env bash
# Breaks one line at a time, in a copy of the tree, and runs the tests that should notice: all lines of
# tools/mutants.txt, or those that contain TEXT. The lines that belong to the paper: '[P17]'.
# Fails when a mutant survives, or when a line that is to be broken is not there any more.
# usage: tools/mutation.sh [TEXT]
# As deep in the tree as an ordinary build, whose objects ccache then takes.
build_dir=build/mutation/build/release
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source tools/instrumented.sh

mapfile -t mutants < <(grep -v '^\(#\|$\)' tools/mutants.txt | grep -F -e "${1:-|}")
((${#mutants[@]})) || die "no line of tools/mutants.txt contains '$1'"
readonly tree=build/mutation log=build/mutation/log

# fields MUTANT: file, old, new, tests
fields() {
    IFS=$'\x1f' read -r file old new tests _ <<<"${1// | /$'\x1f'}"
}

install_packages "${build_packages[@]}"
mkdir -p "$tree"
find "$tree" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
# shellcheck disable=SC2046  # no name in this tree has a space
cp -p --parents $(git ls-files) "$tree"
# What an earlier run, of any lines, built last of a file may be a mutant.
grep -v '^\(#\|$\)' tools/mutants.txt | while read -r mutant; do
    fields "$mutant"
    touch "$tree/$file"
done

source_dir=$tree
configure_instrumented -DCMAKE_UNITY_BUILD=OFF -DPOINTPLANE_BUILD_PYTHON=OFF -DCMAKE_BUILD_TYPE=Release

# passes TEST...: builds and runs; a mutant that does not compile would prove nothing.
passes() {
    local test filter binaries=("${@%%:*}")
    cmake --build "$build_dir" --parallel "$(num_jobs)" --target "${binaries[@]/#/test_}" >"$log" 2>&1 ||
        die "does not compile, see $log"
    for test in "$@"; do
        filter=
        [[ $test != *:* ]] || filter=--gtest_filter=${test#*:}
        timeout 300 "$build_dir/tests/test_${test%%:*}" ${filter:+"$filter"} >"$log" 2>&1 || return 1
    done
}

say "the tests as they are"
declare -A all_tests=()
for mutant in "${mutants[@]}"; do
    fields "$mutant"
    read -ra named <<<"$tests"
    for test in "${named[@]}"; do all_tests[$test]=1; done
done
passes "${!all_tests[@]}" || die "fails without any mutation, see $log"

say "${#mutants[@]} mutants"
survivors=0
for mutant in "${mutants[@]}"; do
    fields "$mutant"
    original=$(<"$tree/$file")
    mutated=${original/"$old"/"$new"}
    [[ $mutated != "$original" ]] || die "$file has no '$old' any more: change tools/mutants.txt"
    printf '%s\n' "$mutated" >"$tree/$file"
    read -ra named <<<"$tests"
    if passes "${named[@]}"; then
        verdict=SURVIVED
        survivors=$((survivors + 1))
    else
        verdict=caught
    fi
    printf '%-8s  %-34s %s -> %s\n' "$verdict" "$file" "$old" "$new"
    printf '%s\n' "$original" >"$tree/$file"
done
printf '%d of %d mutants caught\n' "$((${#mutants[@]} - survivors))" "${#mutants[@]}"
exit $((survivors > 0))
