#!/bin/sh
# A page as Doxygen wants it: headings with the anchors that GitHub gives them, links to these,
# pictures by their bare names, and links out of the documents as text. Doxygen takes no mark and no
# end of a line in the text of a link, and two backquotes around code with a quote. Called by Doxygen.
# usage: site_filter.sh FILE.md
exec awk -v file="$1" '
    function pageOf(path) { sub(/^.*\//, "", path); sub(/\.md$/, "", path); return path }
    # Replaces each ](target) of a line.
    function linked(line,    out, target, end, place) {
        out = ""
        while ((place = index(line, "](")) > 0) {
            out = out unmarked(substr(line, 1, place))
            line = substr(line, place + 2)
            end = index(line, ")")
            target = substr(line, 1, end - 1)
            line = substr(line, end + 1)
            if (target ~ /^[a-z]+:/) out = out "(" target ")"
            else if (target ~ /\.(jpg|svg|png)$/) { sub(/^.*\//, "", target); out = out "(" target ")" }
            else if (target ~ /^#/) out = out "(#" pageOf(file) "-" substr(target, 2) ")"
            else if (target ~ /\.md#/) {
                split(target, part, "#")
                out = out "(#" pageOf(part[1]) "-" part[2] ")"
            }
            else if (target ~ /\.md$/) out = out "(" target ")"
            else out = unlinked(out)
        }
        return out line
    }
    function unmarked(text,    place, label) {
        for (place = length(text); place > 0 && substr(text, place, 1) != "["; --place) {}
        label = substr(text, place + 1)
        gsub(/[`*]/, "", label)
        return substr(text, 1, place) label
    }
    function quoted(line,    part, n, i, mark, out) {
        n = split(line, part, "`")
        if (n % 2 == 0 || line ~ /``/) return line
        out = part[1]
        for (i = 2; i < n; i += 2) {
            mark = part[i] ~ /\047/ ? "``" : "`"
            out = out mark part[i] mark part[i + 1]
        }
        return out
    }
    function unlinked(text,    place) {
        text = substr(text, 1, length(text) - 1)  # ]
        place = length(text)
        while (place > 0 && substr(text, place, 1) != "[") --place
        return substr(text, 1, place - 1) substr(text, place + 1)
    }
    # Pictures that stand in HTML: Doxyfile names them.
    /^<a href="/ { gsub(/"docs\/figures\//, "\""); print; next }
    /^```/ { inCode = !inCode }
    inCode || /^    / { print; next }
    /^##+ / {
        label = tolower($0)
        sub(/^#+ /, "", label)
        gsub(/[^a-z0-9 _-]/, "", label)
        gsub(/ /, "-", label)
        # A level that was left out is an error there.
        if (/^## /) hasSections = 1
        else if (!hasSections) sub(/^#/, "")
        print $0 " {#" pageOf(file) "-" label "}"
        next
    }
    {
        line = $0
        if (begun != "") sub(/^ +/, "", line)
        line = begun line
        begun = line ~ /\[[^]]*$/ ? line " " : ""
        if (begun == "") print quoted(linked(line))
    }
    END { if (begun != "") print begun }' "$1"
