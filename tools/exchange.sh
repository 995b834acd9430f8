#!/usr/bin/env bash
# Rawlogs written on one system are read on another: tools/exchange.sh DIR_A DIR_B
# The two folders are systems that tools/clean_machine.sh has made and built in. Each simulates a
# sequence with embedded and with external images and estimates its motion; both then read what the
# other has written, estimate again, and must find the same path to 2 mm (OpenCV rounds differently
# from one version to the next). Needs root. EXCHANGE_BIN: where the programs are in both.
set -euo pipefail
a=$(realpath "${1:?usage: tools/exchange.sh DIR_A DIR_B}")
b=$(realpath "${2:?usage: tools/exchange.sh DIR_A DIR_B}")
bin=${EXCHANGE_BIN:-/clone/build/release/bin}

# in_system DIR COMMAND...
in_system() {
    local system=$1
    shift
    chroot "$system" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
}

for system in "$a" "$b"; do
    rm -rf "$system/exchange"
    mkdir -p "$system/exchange/own"
    for kind in embedded external; do
        options=()
        [[ $kind == embedded ]] || options=(--external)
        in_system "$system" "$bin/pointplane-simulate" corner -o "/exchange/own/$kind.rawlog" \
            --duration 1.5 --size 320x240 --quiet "${options[@]}" >/dev/null 2>&1
        in_system "$system" "$bin/pointplane-odometry" "/exchange/own/$kind.rawlog" \
            -o "/exchange/own/$kind.vo.rawlog" --since 31 \
            --trajectory "/exchange/own/$kind.txt" --quiet >/dev/null
    done
done
cp -r "$a/exchange/own" "$b/exchange/other"
cp -r "$b/exchange/own" "$a/exchange/other"

for system in "$a" "$b"; do
    version=$(<"$system/etc/debian_version")
    for kind in embedded external; do
        in_system "$system" "$bin/pointplane-odometry" "/exchange/other/$kind.rawlog" \
            --trajectory "/exchange/$kind.txt" --quiet >/dev/null
        # The other's trajectory as text, and its rawlog of pose PDFs.
        in_system "$system" "$bin/pointplane-eval" ate "/exchange/other/$kind.txt" \
            "/exchange/$kind.txt" --align none --max-rmse 0.002 >/dev/null
        in_system "$system" "$bin/pointplane-eval" nees "/exchange/other/$kind.groundtruth.txt" \
            "/exchange/other/$kind.vo.rawlog" --body-from-gt optical >/dev/null
        echo "Debian $version reads the other's rawlog with $kind images and its estimate"
    done
done
