#!/usr/bin/env bash
# Format of the code, by clang-format 14: other releases disagree. Run in the root of the sources.
set -u
for program in clang-format-14 clang-format; do
    [[ $("$program" --version 2>/dev/null) == *"version 14."* ]] || continue
    [[ -e .git ]] || { echo "skipped: not a clone"; exit 0; }
    files=$(git ls-files '*.cpp' '*.h') || exit 1
    xargs -P 2 -n 60 "$program" --dry-run --Werror <<< "$files"
    exit
done
echo "skipped: no clang-format 14"
