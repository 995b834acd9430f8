#!/usr/bin/env bash
# Fuzzes everything that reads what others wrote: tools/fuzz.sh SECONDS [FUZZER...]
# Each fuzzer runs so long; without names, all do. Builds with Clang and sanitizers in build/sanitize-address.
# An input that breaks something stays in build/sanitize-address/fuzz/findings, and the exit code is 1.
build_dir=build/sanitize-address
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source tools/instrumented.sh

seconds=${1:-}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || die "usage: tools/fuzz.sh SECONDS [rawlog|simplemap|klg|folder|text|ini|frames|observations ...]"
shift
fuzzers=("$@")
((${#fuzzers[@]})) || fuzzers=(rawlog simplemap klg folder text ini frames observations)

install_packages "${build_packages[@]}" "${clang_packages[@]}"
configure_instrumented "${clang_address_options[@]}"
build fuzzers

readonly fuzz_dir=$build_dir/fuzz
mkdir -p "$fuzz_dir/findings"
"$fuzz_dir/make_fuzz_corpus" config.ini "$fuzz_dir/seeds"

export ASAN_OPTIONS=$sanitizer_options

# fuzz NAME
fuzz() {
    local fuzzer=$1 corpus=$fuzz_dir/corpus/$1 log=$fuzz_dir/$1.log status=0
    mkdir -p "$corpus"
    if ! "$fuzz_dir/fuzz_$fuzzer" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=3000 -malloc_limit_mb=300 \
        -print_final_stats=1 -artifact_prefix="$fuzz_dir/findings/$fuzzer-" "$corpus" "$fuzz_dir/seeds/$fuzzer" \
        >"$log" 2>&1; then
        grep -v '^#' "$log" | tail -n 60
        echo "FOUND by $fuzzer: see $log and $fuzz_dir/findings"
        status=1
    fi
    awk -v fuzzer="$fuzzer" '
        / cov: / { for (i = 1; i < NF; i++) if ($i == "cov:") edges = $(i + 1) }
        /stat::number_of_executed_units/ { runs = $2 }
        /stat::peak_rss_mb/ { rss = $2 }
        END { printf "%-12s %9d executions, %6d edges reached, %5d MB at most\n", fuzzer, runs, edges, rss }
    ' "$log"
    return "$status"
}

jobs=$(num_jobs)
say "fuzzing: ${fuzzers[*]}, $seconds s each, $jobs at a time"
status=0
running=0
for fuzzer in "${fuzzers[@]}"; do
    if ((running == jobs)); then
        wait -n || status=1
        running=$((running - 1))
    fi
    fuzz "$fuzzer" &
    running=$((running + 1))
done
for ((; running > 0; running--)); do wait -n || status=1; done
exit "$status"
