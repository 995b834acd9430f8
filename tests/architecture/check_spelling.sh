#!/usr/bin/env bash
# Spelling, by codespell. Run in the root of the sources.
set -u
command -v codespell >/dev/null || { echo "skipped: no codespell"; exit 0; }
# Words of the field, names in the code and of people, mistakes that tests make on purpose.
words=nees,lod,fro,kinf,testof,conditionsof,tung,caf,alhpa
git ls-files 2>/dev/null | grep -q . || { echo "skipped: not a clone"; exit 0; }
git ls-files | grep -vE '\.(svg|jpg|png|patch)$' | xargs codespell -L "$words"
