#!/usr/bin/env bash
# The table of docs/paper_figures.md that compares the paper with the code: the files and tests that it
# names exist, the files mark the line with the place in the paper, tools/mutants.txt has a line to
# break that one of these tests must notice, and no row is without. What is done as the paper says
# stands in tools/mutants.txt alone: marks and tests of these places exist. Run in the root of the sources.
set -u
failed=0
rows=0
problem() {
    echo "$*"
    failed=1
}

# is_broken PLACE TESTS: by a mutant of that place, and one of the tests must notice
is_broken() {
    local noticing
    while read -r noticing; do
        [[ $2 != *"$noticing"* ]] || return 0
    done < <(grep -F "| [P17] $1" tools/mutants.txt | grep -oP ':\K\S+(?= \| \[P17\] '"$1"'$)' | tr -d '*')
    return 1
}

while IFS='|' read -r _ place what files tests _; do
    ((++rows))
    place=$(sed -E 's/^ *//; s/ *$//' <<<"$place")
    [[ $files == *'`'* ]] || problem "docs/paper_figures.md: no file:$what"
    [[ $tests == *'`'* ]] || problem "docs/paper_figures.md: no test:$what"
    is_broken "$place" "$tests" || problem "tools/mutants.txt: nothing breaks '$place:$what'"
    mark=$(sed -E 's/^.*, //; s/^ *//; s/ *$//; s/^nowhere$//' <<<"$place")
    for file in $(grep -oE '`[^`]+`' <<<"$files" | tr -d '`'); do
        [[ -f $file ]] || file=libs/$file
        [[ -f $file ]] || problem "docs/paper_figures.md: $file is not there ($place)"
        before='\[P17[^]]*'
        [[ $file != *.ini ]] || before='// '
        grep -qE "$before${mark//./\\.}([^0-9]|$)" "$file" || problem "docs/paper_figures.md: no line of $file is marked [P17 $mark]"
    done
    for test in $(grep -oE '`[^`]+`' <<<"$tests" | tr -d '`'); do
        grep -rqE "TEST(_[FP])?\(${test%.*}, ${test#*.}\)" tests --include='*.cpp' ||
            problem "docs/paper_figures.md: there is no test $test ($place)"
    done
done < <(sed -n '/<!-- paper begin -->/,/<!-- paper end -->/p' docs/paper_figures.md | grep '^|' | tail -n +3)
((rows >= 15)) || problem "docs/paper_figures.md: only $rows rows in the table of the paper"

places=0
while IFS= read -r place; do
    ((++places))
    mark=${place##*, }
    [[ $mark != nowhere ]] || mark=
    grep -rqE "\\[P17[^]]*${mark//./\\.}([^0-9]|\$)" libs apps || grep -qE "// $mark([^0-9]|\$)" config-paper.ini ||
        problem "tools/mutants.txt: no line is marked [P17 $mark]"
done < <(sed -n 's/.*| \[P17\] //p' tools/mutants.txt | sort -u)
((places >= 20)) || problem "tools/mutants.txt: only $places places of the paper"
while IFS= read -r test; do
    grep -rqE "TEST(_[FP])?\(${test%.*}, ${test#*.}" tests --include='*.cpp' ||
        problem "tools/mutants.txt: there is no test $test"
done < <(sed -nE 's/.*:([^ ]+) \| \[P17\] .*/\1/p' tools/mutants.txt | sed -E 's/^\*//; s/\*$//' | grep -F . | sort -u)

while IFS= read -r mutant; do
    IFS=$'\x1f' read -r file old _ <<<"${mutant// | /$'\x1f'}"
    grep -qF -e "$old" "$file" || problem "tools/mutants.txt: $file has no '$old' any more"
done < <(grep -v '^\(#\|$\)' tools/mutants.txt)
exit $failed
