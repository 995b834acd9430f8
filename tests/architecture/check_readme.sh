#!/usr/bin/env bash
# What README.md and docs name exists: links, headings, programs, subcommands and their options.
# README stays short enough to be read.
# Run in the root of the sources. Argument: the folder with the built programs.
set -u
bin=$1
failed=0
problem() {
    echo "$*"
    failed=1
}

# helpOf PROGRAM [SUBCOMMAND]: asked for once, kept in helps.
declare -A helps
helpOf() {
    [[ -n ${helps["$*"]:-} ]] || helps["$*"]=$("$@" --help)
}

for command in demo test; do
    [[ -x $command ]] || problem "./$command is not executable"
    grep -qF "./$command" README.md || problem "README.md does not name ./$command"
done

# anchorsOf PAGE: as GitHub makes them of its headings.
anchorsOf() {
    sed -nE 's/^#+ //p' "$1" | tr '[:upper:]' '[:lower:]' | sed -E 's/[^[:alnum:] _-]//g; s/ /-/g'
}

lines=$(wc -l <README.md)
((lines <= 80)) || problem "README.md has $lines lines; 80 are one and a half screens of 1280x900"

for page in README.md CONTRIBUTING.md docs/*.md docs/tutorials/*.md benchmarks/README.md; do
    while read -r link; do
        target=$page
        [[ $link == '#'* ]] || target=$(dirname "$page")/${link%%#*}
        if [[ ! -e $target ]]; then
            problem "$page: link to $link, which is not there"
        elif [[ $link == *'#'* ]] && ! anchorsOf "$target" | grep -qxF -- "${link#*#}"; then
            problem "$page: link to $link: no such heading"
        fi
    done < <(grep -oE '(\]\(|(href|src)=")[^)" ]+' "$page" | sed -E 's/^(\]\(|[a-z]+=")//' | grep -vE '^[a-z]+:')

    # Commands stand at the beginning of a text between backquotes or of an indented line, and
    # have arguments. pointplane-camera, -status and -recording are keys of comments in rawlogs.
    while read -r line; do
        read -ra words <<<"$line"
        program=$bin/$(basename "${words[0]}")
        if [[ ! -x $program ]]; then
            problem "$page: $(basename "$program") is not built"
            continue
        fi
        helpOf "$program"
        help=${helps["$program"]}
        if [[ ${words[1]} != -* ]] && grep -qE "^  ${words[1]}( |$)" <<<"$help"; then
            helpOf "$program" "${words[1]}"
            help+=${helps["$program ${words[1]}"]}
        fi
        for word in "${words[@]:1}"; do
            option=${word%%=*}
            [[ $option =~ ^--?[a-zA-Z] ]] || continue
            grep -qE "(^|[ ,!])$option([ ,=]|$)" <<<"$help" ||
                problem "$page: $(basename "$program") has no option $option: $line"
        done
    done < <({ grep -oE '`[^`]+`' "$page" | tr -d '`'; grep -E '^    ' "$page"; } |
        sed -nE 's/ #.*//; s/^ *((build[a-z/]*\/)?bin\/)?(pointplane-[a-z]+ .*)/\3/p' |
        grep -vE '^pointplane-(camera|status|recording) ')
done
exit $failed
