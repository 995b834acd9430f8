#!/usr/bin/env bash
# Writes the summary of results of README.md and the bars of docs/figures/rpe_bars.svg from the tables of
# docs/accuracy.md. usage: benchmarks/readme_results.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/tables.sh

# One line per sequence: NAME|chosen on it (yes, other seeds, no)|ours mm|ours deg|fast mm|fast deg|peer mm|peer deg|its name|NEES 1|NEES 1 s
awk -F ' *[|] *' '
    $2 ~ /^-/ { next }
    $2 == "sequence" || $2 == "method" {
        section = $2 == "method" && $3 != "what it is" ? "errors" : $3 == "chosen on it" ? "summary" : ""
        for (i = 3; i < NF; ++i) column[i] = $i
        next
    }
    !/^[|]/ { section = "" }
    section == "summary" { names[++numNames] = $2; chosen_on[$2] = $3; nees_of[$2] = $6 }
    section == "errors" {
        methods[++numMethods] = $2
        for (i = 3; i < NF; ++i)
            if (split($i, e, " / ") == 2) {
                value["mm", $2, column[i]] = e[1]
                value["deg", $2, column[i]] = e[2]
            }
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
            if (split(nees_of[name], n, " / ") == 3) nees = n[1] "|" n[3]
            printf "%s|%s|%s|%s|%s|%s|%s\n", name, chosen_on[name], error("config.ini", name),
                error("config-fast.ini", name), error(best, name), best, nees
        }
    }' docs/accuracy.md >"$work/lines"
[[ -s $work/lines ]] || {
    echo "error: no sequence found in docs/accuracy.md" >&2
    exit 1
}

group() { # yes, other seeds or no; heading
    awk -F '|' -v kind="$1" -v heading="$2" '
        function add(name, value) {
            if (value == "-") return
            if (!(name in least) || value + 0 < least[name] + 0) least[name] = value
            if (!(name in most) || value + 0 > most[name] + 0) most[name] = value
        }
        function range(name) { return name in least ? least[name] " to " most[name] : "-" }
        $2 == kind {
            ++n
            add("ours", $3)
            add("fast", $5)
            add("peer", $7)
            add("nees", $11)
            compared += $3 != "-" && $7 != "-"
            ahead += $3 != "-" && $7 != "-" && $3 + 0 < $7 + 0
        }
        END {
            if (n) printf "| **%d %s** | %s | %s | %s | %d of %d | %s |\n", n, heading,
                range("ours"), range("fast"), range("peer"), ahead, compared, range("nees")
        }' "$work/lines"
}
{
    echo
    echo "| recordings | config.ini [mm] | config-fast.ini [mm] | best peer [mm] | config.ini is ahead in | its NEES |"
    echo "|---|---|---|---|---|---|"
    group yes "on which parameters were chosen"
    group "other seeds" "of simulated scenes, other seeds"
    group no "on which none was chosen"
    echo
} >"$work/results"
replace README.md results "$work/results"

# Bars on a logarithmic scale, ours above the best peer's; first where parameters were chosen.
awk -F '|' '
    function x(mm) { return left + width * log(mm / least) / log(most / least) }
    function bar(y, mm, colour, label) {
        body = body sprintf("<rect x=\"%d\" y=\"%d\" width=\"%.1f\" height=\"9\" fill=\"%s\"/>\n",
            left, y, x(mm) - left, colour)
        body = body sprintf("<text x=\"%.1f\" y=\"%d\" class=\"v\">%s</text>\n", x(mm) + 4, y + 8, label)
    }
    function group(kind, heading,    i, label, n) {
        for (i = 0; i < count; ++i) {
            if (chosen[i] != kind) continue
            if (!n++) {
                body = body sprintf("<text x=\"8\" y=\"%d\" class=\"h\">%s</text>\n", y + 13, heading)
                y += 22
            }
            label = name[i]; sub(/_part$/, "", label); sub(/^tum_/, "", label); gsub(/_/, " ", label)
            sub(/structure notexture/, "notexture", label); sub(/icl living room/, "ICL", label)
            body = body sprintf("<text x=\"%d\" y=\"%d\" class=\"n\">%s</text>\n", left - 8, y + 14, label)
            bar(y, ours[i], "#0072b2", ours[i])
            bar(y + 10, peer[i], "#a3acb5", peer[i] " " by[i])
            y += 26
        }
        if (n) y += 6
    }
    BEGIN { left = 170; width = 290; least = 0.1; most = 1000; count = 0 }
    $7 != "-" { name[count] = $1; chosen[count] = $2; ours[count] = $3; peer[count] = $7; by[count++] = $9 }
    END {
        y = 4
        group("yes", "Parameters were chosen on these")
        group("other seeds", "Same scenes, other seeds")
        group("no", "Not chosen on these")
        print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 " y + 36 "\" width=\"640\" height=\"" y + 36 "\" role=\"img\""
        print " aria-label=\"Relative pose error beside the best peer\" style=\"background:#fff\">"
        print "<style>text{font:12px system-ui,\"DejaVu Sans\",sans-serif;fill:#1c2430}"
        print ".v{font-size:10px;fill:#4a5563}.n{text-anchor:end}.h{font-weight:bold}.t{text-anchor:middle;font-size:11px}</style>"
        for (mm = least; mm <= most * 1.001; mm *= 10)
            printf "<path d=\"M%.1f 4V%d\" stroke=\"#e1e6eb\"/><text x=\"%.1f\" y=\"%d\" class=\"t\">%g</text>\n",
                x(mm), y, x(mm), y + 13, mm
        printf "<text x=\"%d\" y=\"%d\" class=\"t\">relative pose error over 1 s, RMSE [mm]: blue pointplane, grey the best of OpenCV and DIFODO</text>\n",
            320, y + 30
        printf "%s</svg>\n", body
    }' "$work/lines" >docs/figures/rpe_bars.svg
