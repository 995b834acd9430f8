#!/usr/bin/env bash
# Manual page of a program out of its --help: manual_page.sh HELP2MAN PROGRAM VERSION OUTPUT
# help2man expects a space after the comma of `-c,--config`, and text where CLI11 has only a type.
set -euo pipefail
help2man=$1 program=$2 version=$3 output=$4

name=$(basename "$program")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A stand-in with the program's name, whose help is the program's and that of its subcommands.
cat >"$work/$name" <<END
#!/usr/bin/env bash
"$program" --help
"$program" --help | sed -n '/^Subcommands:/,\$s/^  \([a-z][a-z0-9]*\) .*/\1/p' | while read -r command; do
    printf '\nCommand %s:\n\n' "\$command"
    "$program" "\$command" --help | sed '/^ *-h,--help/d; s/^Usage: /\n/'
done
END
chmod +x "$work/$name"
"$work/$name" >"$work/help"

summary=$(head -1 "$work/help")
summary=${summary%.}
sed -E 's/^(  -[a-zA-Z]),--/\1, --/; 1d' "$work/help" >"$work/edited"
printf '#!/bin/sh\ncat "%s"\n' "$work/edited" >"$work/$name"

"$help2man" --no-info --section=1 --manual="pointplane" --source="pointplane $version" \
    --version-string="$name $version" --name="${summary,}" "$work/$name" |
    sed "s|$work/||g" >"$output.new"
mv "$output.new" "$output"
