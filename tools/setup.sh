# shellcheck shell=bash disable=SC2034
# Sourced by ./demo, ./test and the tools: Debian packages, build, job count. Needs bash; changes to
# the clone. Who wants another build folder sets build_dir before. CXX is another compiler than
# Debian's g++, e.g. clang++; what it builds has a folder of its own.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly build_dir=${build_dir:-build/release${CXX:+-${CXX##*/}}}

# A question mark: not in every release. What it is for is left out, or its tests are skipped.
# dpkg-dev and file: README makes Debian packages after ./demo, and cpack needs them.
build_packages=(
    g++ cmake ninja-build pkgconf
    libeigen3-dev libopencv-dev libdlib-dev zlib1g-dev libdeflate-dev libturbojpeg0-dev
    libmrpt-obs-dev libmrpt-graphslam-dev libcli11-dev nlohmann-json3-dev libgtest-dev libgmock-dev
    libopenni2-dev "libfreenect-dev?" help2man "pybind11-dev?" python3-dev
    "librosbag-storage-dev?" "libsensor-msgs-dev?" "libtf2-msgs-dev?"
    dpkg-dev file
)
[[ ${CXX:-} != *clang* ]] || build_packages+=(clang)
# MRPT's own programs and data sets, which the tests run on our output; a browser for the reports;
# the documentation of the code must be complete; spelling and format; Debian packages and the Python
# module; what commands of the documents need.
readonly test_packages=(
    mrpt-apps mrpt-common doxygen "doxygen-awesome-css?" "chromium?" "codespell?" "clang-format-14?"
    lintian python3-numpy fakeroot time
)

say() { printf '\n== %s\n' "$*"; }
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

is_installed() {
    [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

is_offered() {
    [[ -n "$(apt-cache madison "$1" 2>/dev/null)" ]]
}

as_root() {
    if ((EUID == 0)); then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        die "not root and no sudo; as root, run: $*"
    fi
}

apt() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600 "$@"
}

# Ubuntu 24.04 has no MRPT of its own; the archive of MRPT's author has it (docs.mrpt.org, Download).
add_mrpt_archive() {
    if is_offered libmrpt-obs-dev || ! grep -qs '^ID=ubuntu' /etc/os-release; then
        return
    fi
    say "adding ppa:joseluisblancoc/mrpt-stable, as this Ubuntu has no MRPT"
    apt install --yes --no-install-recommends software-properties-common ca-certificates
    as_root add-apt-repository --yes ppa:joseluisblancoc/mrpt-stable ||
        die "could not add ppa:joseluisblancoc/mrpt-stable; MRPT 2.4 or newer is needed"
    apt update
}

# install_packages NAME...: those that are missing; NAME? if it is offered and can be installed.
install_packages() {
    command -v apt-get >/dev/null ||
        die "no apt-get: on another system install the equivalents of $* and run cmake by hand"
    local package missing=() optional=()
    for package in "$@"; do
        is_installed "${package%\?}" && continue
        if [[ $package == *\? ]]; then
            optional+=("${package%\?}")
        else
            missing+=("$package")
        fi
    done
    if ((${#missing[@]})); then
        # Another source of the machine may be unreachable; what matters is whether install succeeds.
        apt update || echo "apt-get update failed; trying with the lists that are there" >&2
        add_mrpt_archive
        say "installing ${missing[*]}"
        apt install --yes --no-install-recommends "${missing[@]}" ||
            die "apt-get could not install ${missing[*]} (its own message is above)"
    fi
    for package in "${optional[@]}"; do
        is_offered "$package" || continue
        say "installing $package"
        (apt install --yes --no-install-recommends "$package") ||
            echo "left out: $package (why is above)" >&2
    done
}

# As many as there are cores, but no more than memory allows: the largest sources take 1.1 GB,
# those for the fuzzers 1.5 GB.
num_jobs() {
    local cores kib limit
    cores=$(nproc)
    kib=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)
    limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
    if [[ $limit != max ]] && ((limit / 1024 < kib)); then
        kib=$((limit / 1024))
    fi
    local jobs=$((kib / 1500000))
    ((jobs >= 1)) || jobs=1
    echo $((jobs < cores ? jobs : cores))
}

# What was compiled before, in this clone or another, is not compiled again.
if command -v ccache >/dev/null && [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]]; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=true
fi

# Eight sources compiled as one take half the time of eight. Who edits one of them is faster without.
readonly fast_build=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=8)

# build TARGET...
build() {
    local jobs
    jobs=$(num_jobs)
    say "building in $build_dir with $jobs jobs"
    if [[ ! -e $build_dir/build.ninja ]]; then
        cmake -S . -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE=Release "${fast_build[@]}"
    fi
    cmake --build "$build_dir" --parallel "$jobs" --target "$@"
}
