#!/usr/bin/env bash
# Tries this clone's commit on a clean Debian: tools/clean_machine.sh SUITE DIR [COMMAND]
#   SUITE    bookworm (Debian 12) or trixie (Debian 13)
#   DIR      where the system is put, 5 GB; it is used again if it is there
#   COMMAND  in the clone [./test]
# Needs root and debootstrap. POINTPLANE_DATA, if set, is there, too. MIRROR is another than Debian's.
# PACKAGES, if set, is a folder that is there as /packages; tools/try_packages.sh as the COMMAND installs,
# uses and removes the Debian packages in it.
# Nothing stays mounted.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage="usage: tools/clean_machine.sh SUITE DIR [COMMAND]"
suite=${1:?$usage}
dir=$(realpath -m "${2:?$usage}")
command=${3:-./test}
if ((EUID != 0)) || ! command -v debootstrap >/dev/null; then
    echo "error: needs root and the package debootstrap" >&2
    exit 3
fi
if [[ -n ${POINTPLANE_DATA:-} && ! -d $POINTPLANE_DATA ]]; then
    echo "error: POINTPLANE_DATA=$POINTPLANE_DATA is not a folder" >&2
    exit 2
fi

if [[ ! -e $dir/etc/debian_version ]]; then
    debootstrap --variant=minbase --include=git,ca-certificates "$suite" "$dir" \
        "${MIRROR:-http://deb.debian.org/debian}"
fi
mkdir -p "$dir/data" "$dir/source" "$dir/packages"
data=
if [[ -n ${POINTPLANE_DATA:-} ]]; then
    data=$(realpath "$POINTPLANE_DATA")
fi

# In a mount namespace of its own; the root there is a mount, as on a machine, so that the tests of
# full disks may mount theirs.
packages=
if [[ -n ${PACKAGES:-} ]]; then
    packages=$(realpath "$PACKAGES")
fi
export dir data packages command
# The repository, not the folder of the sources: that of a worktree is no repository by itself.
source=$(realpath "$(git rev-parse --git-common-dir)") commit=$(git rev-parse HEAD)
export source commit
# shellcheck disable=SC2016  # expanded there
unshare --mount bash -euo pipefail -c '
    mount --bind "$dir" "$dir"
    mount -t proc proc "$dir/proc"
    mount --rbind /dev "$dir/dev"
    mount --bind "$source" "$dir/source"
    [[ -z $data ]] || mount --bind "$data" "$dir/data"
    [[ -z $packages ]] || mount --bind "$packages" "$dir/packages"
    chroot "$dir" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        ${data:+POINTPLANE_DATA=/data} bash -euo pipefail -c "
            git config --global --replace-all safe.directory \"*\"
            [[ -d /clone ]] || git clone --quiet /source /clone
            cd /clone
            git fetch --quiet origin $commit
            git checkout --quiet --detach $commit
            $command"
'
