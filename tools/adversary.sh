#!/usr/bin/env bash
# Thousands of damaged files, wrong values, full disks and outputs that are inputs: every attempt must
# end by itself, with the right exit code, one clear line and all files intact. Rewrites the table of
# docs/robustness.md; what went wrong is listed on the standard error, and the exit code is 1.
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${build_packages[@]}" "${test_packages[@]}"
build adversary

table=$(mktemp)
trap 'rm -f "$table"' EXIT
status=0
"$build_dir/tests/adversary/pointplane-adversary" >"$table" || status=$?
sed -i -e "/^<!-- adversary begin -->$/,/^<!-- adversary end -->$/{/^<!-- adversary begin -->$/{p;r $table
};/^<!-- adversary end -->$/p;d}" docs/robustness.md
exit "$status"
