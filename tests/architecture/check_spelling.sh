#!/usr/bin/env bash
# Spelling, by codespell. Run in the root of the sources.
set -u
command -v codespell >/dev/null || { echo "skipped: no codespell"; exit 0; }
# Words of the field, names in the code and of people, mistakes that tests make on purpose.
words=nees,lod,fro,kinf,testof,conditionsof,tung,caf,alhpa
[[ -e .git ]] || { echo "skipped: not a clone"; exit 0; }
files=$(git ls-files) || exit 1
grep -vE '\.(svg|jpg|png|patch)$' <<< "$files" | xargs codespell -L "$words"
