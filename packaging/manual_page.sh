#!/usr/bin/env bash
# Manual pages of a program out of its --help: manual_page.sh HELP2MAN PROGRAM VERSION OUTPUT COMMANDS
# OUTPUT is the program's page. The folder COMMANDS gets a page for each subcommand, named as git does:
# pointplane-convert-tum.1.
set -euo pipefail
help2man=$1 program=$2 version=$3 output=$4 folder=$5

export COLUMNS=0 # help as it is, whatever the terminal
name=$(basename "$program")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mapfile -t commands < <("$program" --help | sed -n '/^Subcommands:/,$s/^  \([a-z][a-z0-9]*\) .*/\1/p')

# page FILE NAME [COMMAND]: of a stand-in with this name, whose help is the program's. help2man expects a
# space after the comma of `-c,--config`. A long summary stands in NAME up to its colon, and whole below.
# More arguments for help2man are in $also.
page() {
    local summary short
    "$program" "${@:3}" --help >"$work/help"
    summary=$(head -1 "$work/help")
    short=${summary%.}
    ((${#short} <= 90)) || short=${short%%:*}
    sed -E 's/^(  -[a-zA-Z]),--/\1, --/; 1d' "$work/help" |
        {
            sed -u 1q  # usage
            [[ ${summary%.} == "$short" ]] || printf '\n%s.\n' "${summary%.}"
            cat
        } >"$work/edited"
    printf '#!/bin/sh\ncat "%s"\n' "$work/edited" >"$work/$2"
    chmod +x "$work/$2"
    "$help2man" --no-info --section=1 --manual="pointplane" --source="pointplane $version" \
        --version-string="$2 $version" --name="${short,}" "${also[@]}" "$work/$2" |
        sed "s|$work/||g" >"$work/page"
    mv "$work/page" "$1"
}

# see_also PAGE...: the section with these pages, if there are any.
see_also() {
    also=()
    (($# > 0)) || return 0
    printf '[see also]\n' >"$work/also"
    printf '.BR %s (1),\n' "$@" | sed '$s/,$//' >>"$work/also"
    also=(--include="$work/also")
}

rm -rf "$folder"
mkdir -p "$folder"
see_also "$name"
for command in "${commands[@]}"; do
    page "$folder/$name-$command.1" "$name-$command" "$command"
done
see_also "${commands[@]/#/$name-}"
page "$output" "$name"
