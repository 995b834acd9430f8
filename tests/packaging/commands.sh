#!/usr/bin/env bash
# Runs the commands of README, docs, docs/tutorials and benchmarks/README as they are written, but for the
# length and size of what is simulated. Each belongs to one group: commands.sh BUILD WORK VERSION GROUP
#   programs    on a short simulated recording under the names that stand there
#   tutorials   each from its beginning, in a folder of its own
#   lab         pointplane-lab
#   machine     what installs, builds or needs root: stand_in.sh does what must not be done here
#   benchmarks  stand_in.sh does what takes minutes
set -uo pipefail
build=$(realpath "$1") work=$2 group=$4
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
root=$(realpath "$here/../..")
rm -rf "$work"
mkdir -p "$work" && cd "$work" || exit 1
work=$PWD
export PATH=$build/bin:$PATH
failed=0
count=0

# run EXPECTED COMMAND
run() {
    local code=0
    bash -c "$2" </dev/null >"$work/log" 2>&1 || code=$?
    count=$((count + 1))
    if [[ $code != "$1" ]]; then
        echo "exit code $code instead of $1: $2"
        tail -5 "$work/log"
        failed=1
    fi
}

# prepare COMMAND...: what must succeed before.
prepare() {
    "$@" >"$work/log" 2>&1 || { echo "failed: $*"; cat "$work/log"; exit 1; }
}

# written_in PAGE: indented lines, and what stands between backquotes in tables and text. A backslash at the
# end goes on, and a loop is one command. pointplane-camera and pointplane-status are comments of rawlogs.
written_in() {
    local programs='pointplane-|graph|rbpf-slam|observations2map|rawlog-edit|cmake |cpack |cp |sed |echo |printf |export '
    sed -nE 's/^    //p' "$root/$1" | sed -E ':a; /\\$/{N; s/ *\\\n */ /; ba}; s/ +#.*//' |
        sed -E '/^for /{:b; N; /\ndone$/!bb; s/; do\n */; do /; s/\n */; /g}' |
        grep -E "^(for .*|sudo .*|POINTPLANE_DATA=.*|(\./|tools/|benchmarks/|build/|$programs).*)" |
        grep -vE '^pointplane-(camera|status|odometry:)'
    sed -nE 's/^\| `(pointplane-[a-z]+ [^`]+)`.*/\1/p' "$root/$1"
    grep -oE '`[^`]+`' "$root/$1" | tr -d '`' | sed 's/\\|/|/g' |
        grep -E '^(\./(demo|test)|tools/[a-z_]+\.sh|benchmarks/[a-z_]+\.sh [^ ]|build/benchmarks/|cmake --preset)'
}

# group_of PAGE COMMAND
group_of() {
    case $2 in
        ./demo | ./test* | tools/* | cmake\ --preset* | sudo\ * | cpack\ *) echo machine ;;
        *pointplane-lab\ *) echo lab ;;
        cmake\ * | export\ * | *benchmark*) echo benchmarks ;;
        *) [[ $1 == docs/tutorials/* ]] && echo tutorials || echo programs ;;
    esac
}

# each PAGE FUNCTION: with each command of the group.
each() {
    local command
    while read -r command; do
        [[ $(group_of "$1" "$command") != "$group" ]] || "$2" "$command"
    done < <(written_in "$1")
}

pages() {
    (cd "$root" && ls README.md CONTRIBUTING.md docs/*.md docs/tutorials/*.md benchmarks/README.md)
}

# Two seconds of a real sequence are enough here.
real_sequence() {
    [[ -n ${POINTPLANE_DATA:-} ]] || return 0
    local list
    mkdir rgbd_dataset_freiburg1_xyz
    ln -s "$POINTPLANE_DATA"/tum_fr1_xyz_part/* rgbd_dataset_freiburg1_xyz/
    for list in rgb depth; do
        rm rgbd_dataset_freiburg1_xyz/$list.txt
        head -75 "$POINTPLANE_DATA/tum_fr1_xyz_part/$list.txt" >rgbd_dataset_freiburg1_xyz/$list.txt
    done
}

# A folder like a TUM sequence.
tum_folder() {
    prepare pointplane-simulate corner -o seen.rawlog --external --size 160x120 --fps 15 --duration 1.5 --quiet
    prepare "$here/make_recordings.py" tum seen_Images seen.groundtruth.txt "$1"
}

programs() {
    local name
    prepare pointplane-simulate corner -o in.rawlog --duration 1.8 --size 320x240 --quiet
    for name in a b; do
        ln -s in.rawlog $name.rawlog
    done
    cp "$root"/config*.ini .
    mkdir docs
    cp "$root/docs/rbpf.ini" docs
    prepare "$here/make_recordings.py" small .
    ln -s in.groundtruth.txt GT
    ln -s in.groundtruth.txt groundtruth.txt
    prepare pointplane-odometry in.rawlog -o EST.rawlog --only-poses --since 31 --quiet
    prepare pointplane-odometry in.rawlog --trajectory EST --quiet
    for name in A B C; do
        ln -s EST $name
    done
    real_sequence
    for page in $(pages); do
        each "$page" program
    done
}

program() {
    case $1 in
        pointplane-simulate*) run 0 "$(sed -E 's/ --duration [0-9.]+//' <<<"$1") --duration 1.5 --size 320x240" ;;
        # No camera here. The recordings of other commands are not in its way.
        pointplane-grabber*) [[ -e /dev/bus/usb ]] || run 3 "mkdir -p camera && cd camera && $1" ;;
        pointplane-convert\ tum* | *fr1_xyz*) [[ -z ${POINTPLANE_DATA:-} ]] || run 0 "$1" ;;
        pointplane-convert\ bag*) [[ $(bash -c "$1" 2>&1) == *"built without"* ]] || run 0 "$1" ;;
        pointplane-* | for\ *) run 0 "$1" ;;
        *) ! command -v graphslam-engine >/dev/null || run 0 "$1" ;;  # MRPT's own
    esac
}

tutorials() {
    local tutorial before
    real_sequence
    for tutorial in $(pages | grep ^docs/tutorials/); do
        mkdir "$(basename "$tutorial" .md)" && cd "$(basename "$tutorial" .md)" || exit 1
        if grep -q rgbd_dataset_freiburg1_xyz "$root/$tutorial"; then
            [[ -n ${POINTPLANE_DATA:-} ]] || { cd ..; continue; }
            ln -s ../rgbd_dataset_freiburg1_xyz .
        fi
        before=$count
        each "$tutorial" step
        ((count > before)) || { echo "$tutorial: no commands"; failed=1; }
        cd ..
    done
}

step() {
    case $1 in
        pointplane-grabber*) [[ -e /dev/bus/usb ]] || run 3 "$1" ;;  # no camera here
        pointplane-* | printf*) run 0 "$1" ;;
        *) ! command -v "${1%% *}" >/dev/null || run 0 "$1" ;;  # MRPT's own
    esac
}

lab() {
    local name
    prepare pointplane-simulate corner -o a.rawlog --size 160x120 --duration 1.2 --quiet
    cp a.rawlog b.rawlog
    cp a.groundtruth.txt b.groundtruth.txt
    cp "$root/config-paper.ini" .
    ln -s "$build" build
    for name in DIR FOLDER; do
        mkdir $name
        tum_folder $name/rgbd_dataset_freiburg1_desk
    done
    for page in $(pages); do
        each "$page" in_lab
    done
}

in_lab() {
    case $1 in
        *reproduce*) run 0 "$1 --corner-duration 1.2" ;;
        *) run 0 "$1" ;;
    esac
}

# copy_tree: the sources, to be written into.
copy_tree() {
    [[ -e $root/.git ]] || { echo "skipped: no clone"; exit 0; }
    mkdir tree
    (cd "$root" && git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$work/tree") ||
        exit 1
    cd tree || exit 1
}

# stand_ins NAME...: stand_in.sh under these names, before the programs that it stands for.
stand_ins() {
    local name
    mkdir -p "$work/stand_ins"
    for name; do
        ln -s "$here/stand_in.sh" "$work/stand_ins/$name"
    done
    export STAND_IN_BUILD=$build STAND_IN_ROOT=$root STAND_IN_SEEN=$work/seen PATH=$work/stand_ins:$PATH
    mkdir -p "$STAND_IN_SEEN"
    for name; do
        [[ $(command -v "$name") == "$work/stand_ins/$name" ]] || { echo "no stand-in for $name"; exit 1; }
    done
}

machine() {
    copy_tree
    stand_ins sudo apt-get debootstrap unshare mount chroot
    prepare git init --quiet
    prepare git add --all
    prepare git -c user.name=x -c user.email=x commit --quiet --message x
    mkdir build
    ln -s "$build" build/release
    export DESTDIR=$work/installed
    mkdir "$work/names"  # not in the build folder, where ctest is running
    echo "subdirs(\"$build\")" >"$work/names/CTestTestfile.cmake"
    for page in $(pages); do
        each "$page" on_machine
    done
    [[ -x $DESTDIR/usr/local/bin/pointplane-odometry ]] || { echo "nothing was installed"; failed=1; }
}

on_machine() {
    local words
    IFS=' ' read -ra words <<<"${1//\'/}"
    case $1 in
        cpack\ *) [[ -e packages ]] || DESTDIR='' run 0 "$1" ;;
        sudo\ *) run 0 "$1" ;;
        cmake\ --preset*)
            run 0 "[[ \$(cmake --list-presets=all | grep -c '\"${words[2]}\"') == 3 ]]  # $1"
            ;;
        # Hours: only what they are given is looked at.
        *)
            run 0 "[[ -x ${words[0]} ]] && bash -n ${words[0]}  # $1"
            [[ ${words[1]:-} != -R ]] ||
                run 0 "ctest --test-dir '$work/names' -N -R '${words[2]}' | grep -E 'Total Tests: [1-9]'  # $1"
            [[ ${words[1]:-} != \[P* ]] || run 0 "grep -qF '${words[1]}' tools/mutants.txt  # $1"
            ;;
    esac
}

benchmarks() {
    local name target
    tum_folder sequence
    copy_tree
    mkdir DIR
    for name in tum_fr1_xyz_part tum_fr1_rpy_part tum_fr3_structure_notexture_far_part \
        icl_living_room_kt0_part kinect1_fixed_person_part; do
        ln -s "$work/sequence" DIR/$name
    done
    stand_ins cmake
    prepare mkdir -p build/bin
    pointplane-simulate --help >"$STAND_IN_SEEN/scenes"
    for name in pointplane-{simulate,convert,odometry,eval,lab}; do
        ln -s "$here/stand_in.sh" build/bin/$name
    done
    # Where they are built.
    while IFS=: read -r name target; do
        mkdir -p "build/${name%/*}"
        ln -s "$here/stand_in.sh" "build/${name%/*}/${target#*(}"
    done < <(grep -roE 'add_executable\(benchmark_[a-z_]+' benchmarks)
    for page in $(pages); do
        each "$page" benchmark
    done
}

declare -A ran
benchmark() {
    # Several pages have the same.
    [[ -z ${ran["${1#POINTPLANE_DATA=DIR }"]:-} ]] || return 0
    ran["${1#POINTPLANE_DATA=DIR }"]=1
    case $1 in
        export\ *) eval "$1" ;;  # for those after it
        cmake\ *)  # with all that the benchmarks need
            [[ ! -e /usr/include/benchmark/benchmark.h || ! -e /usr/include/opencv4/opencv2/rgbd.hpp ]] || run 0 "$1"
            ;;
        *long_scenes.py*)
            local simulated=${1#POINTPLANE_DATA=DIR }
            run 0 "env -u POINTPLANE_DATA ${simulated/ build / $build } --seeds 1 --scenes desk"
            ;;
        *random_scenes.py*) run 0 "${1/ build / $build } --runs 1" ;;  # real programs: it reads what they write
        *memory.sh* | *performance_tables.sh*) [[ ! -x /usr/bin/time ]] || run 0 "$1" ;;
        *) run 0 "$1" ;;
    esac
}

"$group"
((count > 0)) || { echo "no commands found"; failed=1; }
exit "$failed"
