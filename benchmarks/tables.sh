# shellcheck shell=bash
# Sourced by the scripts that write tables, in the folder of the project. $work is a folder for
# temporary files, which goes when the script ends.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# need_built PROGRAM...
need_built() {
    local program
    for program; do
        [[ -x $program ]] || {
            echo "error: $program is not built (cmake -DPOINTPLANE_BUILD_BENCHMARKS=ON)" >&2
            exit 2
        }
    done
}

# quietly COMMAND...: says what went wrong, nothing else.
quietly() {
    "$@" >"$work/log" 2>&1 || {
        printf 'error: %s\n' "$*" >&2
        cat "$work/log" >&2
        return 1
    }
}

# calibration_errors: options of pointplane-simulate for a camera that is calibrated as well as config.ini
# says.
calibration_errors() {
    awk '$1 == "[Covariance]" {inside = 1; next}
         /^\[/ {inside = 0}
         inside && $1 ~ /^(focalLength|principalPoint|depthScale)$/ {
             print "--set"
             print $1 "Error=" $3
         }' config.ini
}

# replace PAGE NAME FILE: the lines between <!-- NAME:begin --> and <!-- NAME:end -->.
replace() {
    if [[ $(grep -cE "<!-- $2:(begin|end) -->" "$1") != 2 ]]; then
        echo "error: $1 has lost its lines $2:begin and $2:end" >&2
        exit 1
    fi
    sed -i -e "/<!-- $2:begin -->/,/<!-- $2:end -->/{/$2:begin/{p;r $3
};/$2:end/p;d}" "$1"
}
