#!/usr/bin/env bash
# Links of the installed documents lead to installed files: documents.sh BUILD WORK
# tests/architecture/check_readme.sh looks for headings, in the sources.
set -euo pipefail
build=$1 work=$2
rm -rf "$work"
cmake --install "$build" --component doc --prefix "$work" >/dev/null
failed=0
count=0
while read -r page; do
    count=$((count + 1))
    while read -r link; do
        [[ -e $(dirname "$page")/${link%%#*} ]] ||
            { echo "${page#"$work"/}: link to $link, which is not installed"; failed=1; }
    done < <(grep -oE '(\]\(|(href|src)=")[^)"# ]+' "$page" | sed -E 's/^(\]\(|[a-z]+=")//' | grep -vE '^[a-z]+:')
done < <(find "$work" -name '*.md')
((count >= 20)) || { echo "only $count documents found"; failed=1; }
exit "$failed"
