#!/usr/bin/env bash
# Stands in, under their names, for programs that commands.sh must not start, or not for so long. Each checks
# what it is asked for, and does what can be done here.
#   STAND_IN_BUILD  the build folder
#   STAND_IN_ROOT   the sources
#   STAND_IN_SEEN   a folder for what was done before
set -euo pipefail
name=${0##*/}
die() {
    echo "$name: $*" >&2
    exit 99
}

# Where the real one is.
real() {
    PATH=${PATH//${STAND_IN_SEEN%/*}\/stand_ins:/} command -v "$name"
}

# An executable file of the sources, behind assignments: [CXX=...] ./test
is_command() {
    while [[ ${1:-} == *=* ]]; do
        shift
    done
    [[ -x $STAND_IN_ROOT/${1:-} ]] || die "'${1:-}' cannot be run in the sources"
}

# chroot DIR env -i NAME=VALUE... PROGRAM ARGUMENT...: programs run here, on the files there; of scripts the
# syntax and the last line are looked at.
in_other_root() {
    local dir=$1
    [[ -d $dir && $2 == env && $3 == -i ]] || die "$*"
    shift 3
    while [[ $1 == *=* ]]; do
        shift
    done
    case $1 in
        /clone/build/release/bin/*)
            local program=$STAND_IN_BUILD/bin/${1##*/}
            shift
            exec "$program" "${@/#\/exchange/$dir/exchange}"
            ;;
        bash)
            bash -n <<<"${!#}"
            read -ra words < <(tail -1 <<<"${!#}")
            is_command "${words[@]}"
            ;;
        *) die "$*" ;;
    esac
}

# The first run of each kind is real, with little to do; later ones are given what it wrote. The kind is all
# but names of files and values.
run_once() {
    local args=() outputs=() kind=$name word previous='' seen output k=0
    for word; do
        case $previous in
            --duration) word=1.5 ;;
            --size) word=160x120 ;;
            -o | --trajectory | --simplemap | --overlay | --report | --csv | --json | --figure)
                [[ $word == - ]] || outputs+=("$word")
                ;;
        esac
        case $previous,$word in
            --set,*) kind+=",${word%%=*}" ;;
            -c,* | --camera,*) kind+=",${word##*/}" ;;
            *,-*) kind+=",$word" ;;
        esac
        args+=("$word")
        previous=$word
    done
    case $name in
        pointplane-simulate)
            grep -q "^ *$1: " "$STAND_IN_SEEN/scenes" || die "no scene '$1'"
            [[ $* == *--size* ]] || args+=(--size 160x120)
            args+=(--fps 15)
            outputs+=("${outputs[0]%.rawlog}.groundtruth.txt")
            ;;
        pointplane-convert) outputs+=("${outputs[0]%.rawlog}.groundtruth.txt") ;;
        pointplane-eval) kind+=",$1" ;;
    esac
    seen=$STAND_IN_SEEN/${kind//[^a-zA-Z0-9,-]/_}
    if [[ ! -e $seen ]]; then
        mkdir -p "$seen.$$"
        "$STAND_IN_BUILD/bin/$name" "${args[@]}" >"$seen.$$/out"
        for output in "${outputs[@]}"; do
            # There are fewer pictures than benchmarks/pictures.sh chooses from.
            [[ ! -e $output/000010.jpg ]] || cp "$output/000010.jpg" "$output/000100.jpg"
            cp -r "$output" "$seen.$$/$((++k))"
        done
        mv -T "$seen.$$" "$seen" 2>/dev/null || rm -r "$seen.$$"  # another was quicker
        k=0
    fi
    for output in "${outputs[@]}"; do
        [[ ! -e $output ]] || rm -r "$output"
        cp -r "$seen/$((++k))" "$output"
    done
    printf '%s\n' "$(<"$seen/out")"
}

# Its options are those in its sources, and the pages that it writes have its marks.
benchmark() {
    local folder previous='' section='' page='' word
    folder=$(dirname "$(grep -lrE "add_executable\($name( |$)" "$STAND_IN_ROOT/benchmarks")")
    section=${folder##*/}
    for word; do
        [[ $word != --* ]] || grep -rqF "\"$word\"" "$folder" || die "no option $word in $folder"
        [[ $word != *.md ]] || page=$word
        [[ $previous != --section ]] || section=$word
        [[ $previous != --data || -d $word ]] || die "no folder $word"
        if [[ $previous == --csv ]]; then
            printf '%s,1,0,0,0.09,0.06,0.05\n' tum_fr1_xyz_part tum_fr1_rpy_part >"$word"
            printf '%s,1,0,0,0.09,0.06,0.05\n' tum_fr3_structure_notexture_far_part >>"$word"
        fi
        previous=$word
    done
    [[ -z $page ]] || grep -qF "<!-- $section:begin -->" "$page" || die "no $section in $page"
    echo '| a table |'
}

case $name in
    sudo)
        while [[ $1 == *=* ]]; do
            export "${1?}"
            shift
        done
        [[ $1 =~ ^(cmake|apt-get|tools/.*)$ && -n $DESTDIR ]] || die "not as root: $*"
        if ((EUID == 0)); then
            exec "$@"
        fi
        exec fakeroot "$@"
        ;;
    apt-get) exec "$(real)" --simulate "$@" ;;
    debootstrap)
        while [[ $1 == --* ]]; do
            shift
        done
        grep -q "($1)" "$STAND_IN_ROOT/docs/platforms.md" || die "'$1' is no suite that was tried"
        mkdir -p "$2"/{etc,proc,dev}
        echo stand-in >"$2/etc/debian_version"
        ;;
    unshare)
        [[ $1 == --mount ]] || die "$*"
        exec "${@:2}"
        ;;
    mount) [[ -d ${!#} ]] || die "no folder ${!#}" ;;
    chroot) in_other_root "$@" ;;
    cmake)
        if [[ $1 == -B ]]; then
            seen=$STAND_IN_SEEN/${*//[^a-zA-Z0-9-]/_}
            [[ -e $seen ]] || "$(real)" "$@"
            touch "$seen"
        else
            # Not built; but the targets are there.
            [[ $1 == --build ]] || die "$*"
            target=all
            [[ ${3:-} != --target ]] || target=$4
            "$(real)" --build "$2" --target help | grep -w -- "$target" >/dev/null || die "no target $target in $2"
        fi
        ;;
    pointplane-lab)
        bin=$(dirname "$0")
        exec "$STAND_IN_BUILD/bin/$name" "$@" --corner-duration 1.2 --odometry "$bin/pointplane-odometry" \
            --simulate "$bin/pointplane-simulate" --convert "$bin/pointplane-convert"
        ;;
    pointplane-*) run_once "$@" ;;
    benchmark_*) benchmark "$@" ;;
    *) die "$*" ;;
esac
