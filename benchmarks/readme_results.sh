#!/usr/bin/env bash
# Writes the results of README.md and the bars of docs/figures/rpe_bars.svg from the tables of
# docs/accuracy.md. usage: benchmarks/readme_results.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/tables.sh

# One line per sequence: NAME|chosen on it (yes, other seeds, no)|ours mm|ours deg|fast mm|fast deg|peer mm|peer deg|its name|NEES 1|NEES 1 s
awk -F ' *[|] *' '
    NF == 9 && $2 != "sequence" && $2 !~ /^-/ { names[++numNames] = $2; chosen_on[$2] = $3 }
    /^RPE over a second, mm:/ { section = "mm" }
    /^The same, deg:/ { section = "deg" }
    /^NEES over/ { section = "nees" }
    /^(Frames lost|Time per frame)/ { section = "" }
    section != "" && $2 == "method" { for (i = 3; i < NF; ++i) sequence[i] = $i; next }
    section != "" && NF > 3 && $2 !~ /^-/ {
        if (section == "mm") methods[++numMethods] = $2
        for (i = 3; i < NF; ++i) value[section, $2, sequence[i]] = $i
    }
    function error(method, name) {
        if (value["mm", method, name] !~ /^[0-9.]+$/) return "-|-"
        return value["mm", method, name] "|" value["deg", method, name]
    }
    END {
        for (k = 1; k <= numNames; ++k) {
            name = names[k]
            best = "-"
            for (j = 1; j <= numMethods; ++j)
                if (methods[j] ~ /^(OpenCV|DIFODO)/ && value["mm", methods[j], name] ~ /^[0-9.]+$/ &&
                    (best == "-" || value["mm", methods[j], name] + 0 < value["mm", best, name] + 0))
                    best = methods[j]
            nees = "-|-"
            if (split(value["nees", "config.ini", name], n, " / ") == 3) nees = n[1] "|" n[3]
            printf "%s|%s|%s|%s|%s|%s|%s\n", name, chosen_on[name], error("config.ini", name),
                error("config-fast.ini", name), error(best, name), best, nees
        }
    }' docs/accuracy.md >"$work/lines"
[[ -s $work/lines ]] || {
    echo "error: no sequence found in docs/accuracy.md" >&2
    exit 1
}

rows() { # yes, other seeds or no; heading
    awk -F '|' -v kind="$1" -v heading="$2" '
        function pair(mm, deg) { return mm == "-" ? "-" : mm " / " deg }
        $2 == kind {
            if (!n++) print "| **" heading "** | | | | |"
            name = $1; sub(/_part$/, "", name); sub(/^tum_/, "", name); gsub(/_/, " ", name)
            if (name ~ /^iphone/) name = name " (truth: its own odometry)"
            printf "| %s | %s | %s | %s | %s / %s |\n", name, pair($3, $4), pair($5, $6),
                $9 == "-" ? "-" : pair($7, $8) " (" $9 ")", $10, $11
        }' "$work/lines"
}
{
    echo
    echo "| recording | config.ini [mm / deg] | config-fast.ini [mm / deg] | best peer [mm / deg] | NEES over 1 frame / 1 s |"
    echo "|---|---|---|---|---|"
    rows yes "parameters were chosen on these"
    rows "other seeds" "on the same scenes, but other seeds"
    rows no "not chosen on these, except as *decisions* below says"
    echo
} >"$work/results"
replace README.md results "$work/results"

# Bars on a logarithmic scale, ours above the best peer's.
awk -F '|' '
    function x(mm) { return left + width * log(mm / least) / log(most / least) }
    function bar(y, mm, colour, label) {
        printf "<rect x=\"%d\" y=\"%d\" width=\"%.1f\" height=\"11\" fill=\"%s\"/>\n",
            left, y, x(mm) - left, colour
        printf "<text x=\"%.1f\" y=\"%d\" class=\"v\">%s</text>\n", x(mm) + 4, y + 10, label
    }
    BEGIN { left = 170; width = 300; least = 0.1; most = 1000; n = 0 }
    $7 != "-" { name[n] = $1; ours[n] = $3; peer[n] = $7; by[n] = $9; ++n }
    END {
        height = 46 + 32 * n
        print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 " height "\" role=\"img\""
        print " aria-label=\"Relative pose error beside the best peer\" style=\"background:#fff\">"
        print "<style>text{font:12px system-ui,\"DejaVu Sans\",sans-serif;fill:#1c2430}"
        print ".v{font-size:11px;fill:#4a5563}.n{text-anchor:end}.t{text-anchor:middle;font-size:11px}</style>"
        for (mm = least; mm <= most * 1.001; mm *= 10)
            printf "<path d=\"M%.1f 4V%d\" stroke=\"#e1e6eb\"/><text x=\"%.1f\" y=\"%d\" class=\"t\">%g</text>\n",
                x(mm), height - 34, x(mm), height - 20, mm
        printf "<text x=\"%d\" y=\"%d\" class=\"t\">relative pose error over 1 s, RMSE [mm]: blue pointplane, grey the best of OpenCV and DIFODO</text>\n",
            320, height - 4
        for (i = 0; i < n; ++i) {
            label = name[i]; sub(/_part$/, "", label); sub(/^tum_/, "", label); gsub(/_/, " ", label)
            sub(/structure notexture/, "notexture", label); sub(/icl living room/, "ICL", label)
            y = 6 + 32 * i
            printf "<text x=\"%d\" y=\"%d\" class=\"n\">%s</text>\n", left - 8, y + 16, label
            bar(y, ours[i], "#0072b2", ours[i])
            bar(y + 12, peer[i], "#a3acb5", peer[i] " " by[i])
        }
        print "</svg>"
    }' "$work/lines" >docs/figures/rpe_bars.svg
