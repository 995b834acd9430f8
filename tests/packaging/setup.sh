#!/usr/bin/env bash
# What tools/setup.sh does if packages cannot be installed. Nothing is installed here.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/setup.sh"
failed=0
is_installed() { [[ $1 == there* ]]; }
is_offered() { [[ $1 != unknown* ]]; }
apt-get() { :; }
as_root() {
    [[ "$*" != *install*broken* ]] || die "no connection"
    echo "done: $*"
}

# expect CODE WORDS ABSENT PACKAGE...: asking for the packages ends with CODE, and says WORDS, not ABSENT.
expect() {
    local code=0 said
    said=$( (install_packages "${@:4}") 2>&1) || code=$?
    if [[ $code != "$1" || $said != *"$2"* || (-n $3 && $said == *"$3"*) ]]; then
        printf 'packages %s: exit code %s instead of %s, or not "%s", or "%s":\n%s\n' "${*:4}" "$code" "$1" "$2" "$3" "$said"
        failed=1
    fi
}
expect 0 '' install there 'there-too?' 'unknown?'
expect 0 'left out: broken' '' needed 'broken?'
expect 0 'recommends needed' 'left out: needed' needed 'broken?'
expect 0 'recommends good' 'left out: good' needed 'broken?' 'good?'
expect 1 'error: no connection' good broken 'good?'
exit "$failed"
