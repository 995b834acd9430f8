#!/usr/bin/env bash
# Makes the Debian packages and looks into them: debian.sh BUILD WORK VERSION
set -euo pipefail
umask 077  # what is packed can be read all the same
build=$1 work=$2 version=$3
if ! command -v dpkg-shlibdeps >/dev/null; then
    echo "skipped: no dpkg-dev"
    exit 0
fi
failed=0
problem() {
    echo "$*"
    failed=1
}

rm -rf "$work"
mkdir -p "$work"
# Who hands packages on gives an address; the default is none.
cpack --config "$build/CPackConfig.cmake" -B "$work" -D CPACK_PACKAGE_CONTACT="A Tester <tester@example.org>" \
    >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
arch=$(dpkg --print-architecture)

# expect PACKAGE ARCHITECTURE FILE...: each FILE, a pattern, is in it.
expect() {
    local deb=$work/$1_${version}_$2.deb pattern
    [[ -e $deb ]] || { problem "no $(basename "$deb")"; return; }
    contents=$(dpkg-deb --contents "$deb")
    ! grep -E '^(d|-rwx)' <<<"$contents" | grep -vE '^.rwxr-xr-x' || problem "$1 is not for everyone"
    ! grep -E '^-rw-' <<<"$contents" | grep -v '^-rw-r--r--' || problem "$1 is not for everyone"
    contents=$(awk '{print $6}' <<<"$contents")
    for pattern in "${@:3}" "./usr/share/doc/$1/copyright" "./usr/share/doc/$1/changelog.gz"; do
        grep -qE "^$pattern( |$)" <<<"$contents" || problem "$1 lacks $pattern"
    done
    depends=$(dpkg-deb --field "$deb" Depends)
    dpkg-deb --extract "$deb" "$work/unpacked"
}

programs=(convert eval grabber odometry simulate)
files=(./usr/share/pointplane/config{,-fast,-paper}.ini)
for program in "${programs[@]}"; do
    files+=("./usr/bin/pointplane-$program" "./usr/share/bash-completion/completions/pointplane-$program")
    ! command -v help2man >/dev/null || files+=("./usr/share/man/man1/pointplane-$program.1.gz")
done
expect pointplane "$arch" "${files[@]}"
grep -qE '(^|, )libmrpt-obs[0-9.]+' <<<"$depends" || problem "pointplane does not depend on MRPT: $depends"
grep -qE '(^|, )libopencv-core' <<<"$depends" || problem "pointplane does not depend on OpenCV: $depends"
expect libpointplane-dev "$arch" './usr/lib/.*/?libpointplane_mrpt_io\.a' \
    ./usr/include/pointplane/mrpt_io/VisualOdometry.h './usr/lib/.*cmake/pointplane/pointplane-config\.cmake'
grep -q libmrpt-obs-dev <<<"$depends" || problem "libpointplane-dev does not depend on MRPT: $depends"
expect pointplane-doc all ./usr/share/doc/pointplane-doc/README.md \
    ./usr/share/doc/pointplane-doc/docs/theory.md
if [[ -e $build/python ]] && compgen -G "$build/python/*.so" >/dev/null; then
    expect python3-pointplane "$arch" './usr/lib/python3/dist-packages/pointplane\..*\.so'
    grep -q python3-numpy <<<"$depends" || problem "python3-pointplane does not depend on NumPy: $depends"
fi

# check_page PROGRAM [COMMAND]: it has all options; a page of a command and that of its program name each other.
check_page() {
    command -v help2man >/dev/null || return 0
    local folder=$work/unpacked/usr/share/man/man1 page=pointplane-$1${2:+-$2} text option
    [[ -e $folder/$page.1.gz ]] || { problem "no manual page $page"; return; }
    text=$(zcat "$folder/$page.1.gz" | tr -d '\\')
    for option in $("$work/unpacked/usr/bin/pointplane-$1" ${2:+"$2"} --help |
        grep -oE '^  (-[a-z],)?--[a-z][a-z0-9-]+' | grep -oE -- '--.*'); do
        [[ $text == *"$option"* ]] || problem "the manual page $page lacks $option"
    done
    [[ -n ${2:-} ]] || return 0
    [[ $text == *"BR pointplane-$1 (1)"* ]] || problem "$page does not name pointplane-$1"
    zcat "$folder/pointplane-$1.1.gz" | grep -qF "BR $page (1)" || problem "pointplane-$1 does not name $page"
}

# The programs in the package run, and read their configurations.
for program in "${programs[@]}"; do
    [[ $("$work/unpacked/usr/bin/pointplane-$program" --version) == "$version"* ]] ||
        problem "pointplane-$program --version is not $version"
    check_page "$program"
    while read -r command; do
        check_page "$program" "$command"
    done < <("$work/unpacked/usr/bin/pointplane-$program" --help |
        sed -n '/^Subcommands:/,$s/^  \([a-z][a-z0-9]*\) .*/\1/p')
done
for config in "$work"/unpacked/usr/share/pointplane/*.ini; do
    "$work/unpacked/usr/bin/pointplane-odometry" -c "$config" --dump-config >/dev/null ||
        problem "$config is not read"
done

if command -v lintian >/dev/null; then
    # Debian 12's lintian must have nothing to inform of, either. Flags of dpkg-buildflags are set by who
    # builds for Debian.
    levels=error,warning
    [[ $(lintian --version) != *v2.116.* ]] || levels+=,info,pedantic
    lintian --allow-root --tag-display-limit 0 --display-info --pedantic --fail-on "$levels" \
        --suppress-tags hardening-no-fortify-functions "$work"/*.deb || failed=1
fi
exit "$failed"
