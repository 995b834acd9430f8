#!/usr/bin/env bash
# Installs the Debian packages in /packages, uses them, and removes them again without a trace. For a
# system that can be thrown away, as tools/clean_machine.sh makes it.
set -euo pipefail
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}
# has PACKAGE: it is among the packages.
has() {
    compgen -G "/packages/$1_*.deb" >/dev/null || { echo "not tried: there is no $1"; return 1; }
}
export DEBIAN_FRONTEND=noninteractive
if ! compgen -G "/packages/*.deb" >/dev/null || [[ ! -e /clone ]]; then
    die "only on a clean machine with /packages: see tools/clean_machine.sh"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

apt-get -q update
find / -xdev -iname '*pointplane*' -not -path '/clone/*' -not -path '/packages/*' | sort >before
apt-get -q install --yes --no-install-recommends /packages/*.deb

pointplane-simulate corner -o in.rawlog --duration 1 --size 320x240 --quiet
pointplane-odometry -c /usr/share/pointplane/config.ini in.rawlog -o out.rawlog --trajectory out.txt --quiet
pointplane-eval ate in.groundtruth.txt out.txt --max-rmse 0.02
# A TUM folder, by the commands of its tutorial.
if [[ -d /data/tum_fr1_xyz_part ]]; then
    ln -s /data/tum_fr1_xyz_part rgbd_dataset_freiburg1_xyz
    mapfile -t commands < <(sed -nE ':a; /\\$/{N; s/\\\n//; ba}; s/^    (pointplane-.*)/\1/p' /clone/docs/tutorials/tum_sequence.md)
    ((${#commands[@]} > 2)) || die "docs/tutorials/tum_sequence.md has ${#commands[@]} commands; at least 3 were expected"
    for command in "${commands[@]}"; do
        echo "\$ $command"
        bash -c "$command" </dev/null
    done
fi
if has python3-pointplane; then
    python3 -c '
import pointplane
vo = pointplane.VisualOdometry("/usr/share/pointplane/config.ini")
for frame in pointplane.read_rawlog("in.rawlog"):
    result = vo.process(frame)
assert result.status == "tracked", result
print("python:", result, result.covariance.shape)'
fi
# A program of somebody else, against libpointplane-dev alone.
if has libpointplane-dev; then
    apt-get -q install --yes --no-install-recommends g++ cmake make pkgconf
    cmake -S /clone/tests/consumer -B consumer -DCMAKE_BUILD_TYPE=Release
    cmake --build consumer
    ./consumer/consumer /usr/share/pointplane/config.ini in.rawlog | tail -1
fi

mapfile -t packages < <(for deb in /packages/*.deb; do dpkg-deb --field "$deb" Package; done)
apt-get -q purge --yes "${packages[@]}"
find / -xdev -iname '*pointplane*' -not -path '/clone/*' -not -path '/packages/*' | sort >after
diff before after || die "the packages left something behind"
echo "installed, used and removed: ${packages[*]}"
