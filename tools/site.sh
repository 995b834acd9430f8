#!/usr/bin/env bash
# The documents and the reference of the code as a site: FOLDER/doxygen/index.html (default: out).
# With Debian's doxygen-awesome-css in its theme, without it in Doxygen's own. Checks all links.
# usage: tools/site.sh [FOLDER]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-out}
theme=/usr/share/doxygen-awesome-css
mkdir -p "$folder"
rm -rf "$folder/doxygen"
{
    cat docs/Doxyfile
    echo "OUTPUT_DIRECTORY = $folder"
    if [[ -e $theme/doxygen-awesome.css ]]; then
        echo "HTML_EXTRA_STYLESHEET = $theme/doxygen-awesome.css $theme/doxygen-awesome-sidebar-only.css"
        echo "GENERATE_TREEVIEW = YES"
        echo "HTML_COLORSTYLE_SAT = 80"
    fi
} >"$folder/Doxyfile"
doxygen "$folder/Doxyfile"
rm "$folder/Doxyfile"
tools/check_links.py "$folder/doxygen"
