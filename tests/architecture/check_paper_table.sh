#!/usr/bin/env bash
# The table of docs/theory.md that compares the paper with the code: the files and tests that it
# names exist, the files mark the line with the place in the paper, and no row is without. Run in the
# root of the sources.
set -u
failed=0
rows=0
problem() {
    echo "docs/theory.md: $*"
    failed=1
}

while IFS='|' read -r _ place what files tests _; do
    ((++rows))
    [[ $files == *'`'* ]] || problem "no file:$what"
    [[ $tests == *'`'* ]] || problem "no test:$what"
    mark=$(sed -E 's/^.*, //; s/^ *//; s/ *$//; s/^nowhere$//' <<<"$place")
    for file in $(grep -oE '`[^`]+`' <<<"$files" | tr -d '`'); do
        [[ -f $file ]] || file=libs/$file
        [[ -f $file ]] || problem "$file is not there ($place)"
        before='\[P17[^]]*'
        [[ $file != *.ini ]] || before='// '
        grep -qE "$before${mark//./\\.}([^0-9]|$)" "$file" || problem "no line of $file is marked [P17 $mark]"
    done
    for test in $(grep -oE '`[^`]+`' <<<"$tests" | tr -d '`'); do
        grep -rqE "TEST(_[FP])?\(${test%.*}, ${test#*.}\)" tests --include='*.cpp' ||
            problem "there is no test $test ($place)"
    done
done < <(sed -n '/<!-- paper begin -->/,/<!-- paper end -->/p' docs/theory.md | grep '^|' | tail -n +3)
((rows >= 20)) || problem "only $rows rows in the table of the paper"
exit $failed
