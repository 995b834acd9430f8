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
        function range(name) { return name in least ? least[name] "–" most[name] : "-" }
        $2 == kind {
            ++n
            real += $1 !~ /^(simulated|icl)/
            add("ours", $3)
            add("fast", $5)
            add("peer", $7)
            add("nees", $11)
            compared += $3 != "-" && $7 != "-"
            ahead += $3 != "-" && $7 != "-" && $3 + 0 < $7 + 0
        }
        END {
            if (0 < real && real < n) heading = heading ", " real " of them real"
            if (n) printf "| **%d %s** | %s | %s | %s | %d of %d | %s |\n", n, heading,
                range("ours"), range("fast"), range("peer"), ahead, compared, range("nees")
        }' "$work/lines"
}
{
    echo
    echo "| RPE over 1 s [mm] | config.ini | config-fast.ini | best peer | ahead | NEES |"
    echo "|---|---|---|---|---|---|"
    group yes "sequences used for tuning"
    group "other seeds" "scenes; poses tuned on other seeds"
    group no "sequences not used for tuning"
    echo
} >"$work/results"
replace README.md results "$work/results"

# Bars on a logarithmic scale, ours above the best peer's; first where parameters were chosen. The letters are
# large: README shows the picture small.
awk -F '|' '
    function x(mm) { return left + width * log(mm / least) / log(most / least) }
    function bar(y, mm, colour) {
        body = body sprintf("<rect x=\"%d\" y=\"%d\" width=\"%.1f\" height=\"10\" fill=\"%s\"/>\n",
            left, y, x(mm) - left, colour)
        body = body sprintf("<text x=\"%.1f\" y=\"%d\" class=\"v\">%s</text>\n", x(mm) + 4, y + 10, mm)
    }
    function group(kind, heading,    i, label, n) {
        for (i = 0; i < count; ++i) {
            if (chosen[i] != kind) continue
            if (!n++) {
                body = body sprintf("<text x=\"8\" y=\"%d\" class=\"h\">%s</text>\n", y + 15, heading)
                y += 23
            }
            label = name[i]; sub(/_part$/, "", label); sub(/^tum_/, "", label); gsub(/_/, " ", label)
            sub(/structure notexture far/, "notexture", label); sub(/icl living room/, "ICL", label)
            sub(/^simulated /, "", label); sub(/ lidar bedroom/, "", label); sub(/ fixed person/, "", label)
            body = body sprintf("<text x=\"%d\" y=\"%d\" class=\"n\">%s</text>\n", left - 8, y + 16, label)
            bar(y, ours[i], "#0072b2")
            bar(y + 11, peer[i], "#a3acb5")
            y += 27
        }
        if (n) y += 5
    }
    BEGIN { left = 128; width = 255; least = 0.1; most = 1000; count = 0 }
    $7 != "-" { name[count] = $1; chosen[count] = $2; ours[count] = $3; peer[count++] = $7 }
    END {
        y = 22
        group("yes", "Used for tuning")
        group("other seeds", "Simulated, other seeds")
        group("no", "Not used for tuning")
        print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 440 " y + 24 "\" width=\"440\" height=\"" y + 24 "\" role=\"img\""
        print " aria-label=\"Relative pose error beside the best peer\" style=\"background:#fff\">"
        print "<style>text{font:15px system-ui,\"DejaVu Sans\",sans-serif;fill:#1c2430}"
        print ".v{font-size:12px;fill:#4a5563}.n{text-anchor:end}.h{font-weight:bold}.t{text-anchor:middle;font-size:13px}</style>"
        print "<text x=\"8\" y=\"17\">RPE over 1 s [mm]:</text>"
        print "<rect x=\"160\" y=\"7\" width=\"12\" height=\"11\" fill=\"#0072b2\"/><text x=\"177\" y=\"17\">pointplane</text>"
        print "<rect x=\"280\" y=\"7\" width=\"12\" height=\"11\" fill=\"#a3acb5\"/><text x=\"297\" y=\"17\">best peer</text>"
        for (mm = least; mm <= most * 1.001; mm *= 10)
            printf "<path d=\"M%.1f 24V%d\" stroke=\"#e1e6eb\"/><text x=\"%.1f\" y=\"%d\" class=\"t\">%g</text>\n",
                x(mm), y, x(mm), y + 15, mm
        printf "%s</svg>\n", body
    }' "$work/lines" >docs/figures/rpe_bars.svg
