#!/usr/bin/env bash
# No unfinished work, no paths of one machine, no missing licence line. Run in the root of the sources.
set -u
failed=0
fail() {
    if [[ -n $2 ]]; then
        printf '%s:\n%s\n' "$1" "$2"
        failed=1
    fi
}

texts=(README.md CHANGELOG.md CONTRIBUTING.md CMakeLists.txt demo test cmake docs libs apps python packaging tools)
fail "unfinished" "$(grep -rnIwE 'TODO|FIXME|XXX|HACK|WIP' "${texts[@]}")"
fail "unfinished" "$(grep -rnIiE 'not (yet )?implemented|placeholder|for now\b|to be written' "${texts[@]}")"
fail "a path of one machine" \
    "$(grep -rnIE '/(work|root|home/[a-z]+)/' "${texts[@]}" tests benchmarks --exclude-dir=architecture)"
fail "tests that do not run" "$(grep -rnE 'DISABLED_' tests --include='*.cpp' --include='*.h')"
fail "a number in the program's locale, not number_text.h" \
    "$(grep -rnE 'printf|mrpt::format' libs --include='*.cpp' --include='*.h' -A8 |
        grep -E '"[^"]*%[-+#0-9.*]*[aefgAEFG][^"]*"')"
fail "no SPDX line" \
    "$(grep -rL 'SPDX-License-Identifier: BSD-3-Clause' libs apps --include='*.h' --include='*.cpp')"
exit $failed
