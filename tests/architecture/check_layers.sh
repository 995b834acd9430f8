#!/usr/bin/env bash
# Who may include whom: docs/architecture.md. Run in the root of the sources.
set -u
failed=0

# fail RULE MATCHES: reports the matching lines, if any.
fail() {
    if [[ -n $2 ]]; then
        printf '%s:\n%s\n' "$1" "$2"
        failed=1
    fi
}

# allow LIB OTHER...: libraries of this project whose headers it includes.
allow() {
    local lib=$1 others
    checked+=("$lib")
    others=$(IFS='|' && echo "$*")
    fail "libs/$lib may not include" \
        "$(grep -rnE '#include <pointplane/' "libs/$lib" | grep -vE "<pointplane/($others)/")"
}

checked=()
allow core
allow sensor core
allow points core sensor
allow planes core sensor
allow pose core
allow odometry core sensor points planes pose
allow evaluation core
allow simulation core sensor
allow mrpt_io core sensor points planes pose odometry
allow grabber core sensor odometry mrpt_io

for dir in libs/*/; do
    [[ " ${checked[*]} " == *" $(basename "$dir") "* ]] || fail "no rule for the library" "$dir"
done

fail "MRPT stays behind mrpt_io" \
    "$(grep -rnE --exclude-dir=mrpt_io --exclude-dir=grabber '#include <mrpt/' libs)"
fail "OpenCV is not for" "$(grep -rnE '#include <opencv2/' libs/core libs/pose libs/evaluation)"
fail "a header may be read twice: it begins with #pragma once" \
    "$(grep -rL --include='*.h' '^#pragma once' libs apps)"
fail "mrpt::vision is not for new code" "$(grep -rnE 'mrpt/vision' libs apps)"
fail "libraries do not print, nor read the environment" \
    "$(grep -rnE 'std::(cout|cerr|clog)|(^|[^a-z])f?printf\(|getenv' libs | grep -vE ':[0-9]+: *(\*|//|/\*)')"
exit $failed
