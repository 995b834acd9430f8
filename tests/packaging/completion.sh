#!/usr/bin/env bash
# Completion of command lines in bash: completion.sh BUILD
set -euo pipefail
PATH=$(realpath "$1")/bin:$PATH
source "$(dirname "${BASH_SOURCE[0]}")/../../packaging/completion.bash"
failed=0

# expect WORD... : REPLY: completing the last WORD offers REPLY.
expect() {
    local reply=${!#}
    COMP_WORDS=("${@:1:$#-2}")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    COMPREPLY=()
    _pointplane
    if ! printf '%s\n' "${COMPREPLY[@]}" | grep -qxF -- "$reply"; then
        echo "completing '${COMP_WORDS[*]}' does not offer $reply, only: ${COMPREPLY[*]}"
        failed=1
    fi
}
expect pointplane-odometry --traj : --trajectory
expect pointplane-odometry in.rawlog - : -o
expect pointplane-eval r : rpe
expect pointplane-eval rpe --fixed : --fixed-delta
expect pointplane-convert t : tum
expect pointplane-convert tum --cam : --camera
expect pointplane-simulate desk --camera az : azure
expect pointplane-simulate cab : cabinet
expect pointplane-simulate desk --set focalLengthE : focalLengthError=
expect pointplane-odometry --trajectory-frame r : robot
expect pointplane-odometry in.rawlog --set Pipeline.maxG : Pipeline.maxGap=
exit "$failed"
