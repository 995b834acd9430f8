#!/usr/bin/env bash
# Runs the commands of README, docs and docs/tutorials as they are written; outside of the tutorials on
# a short simulated recording under the names that stand there. commands.sh BUILD WORK
set -uo pipefail
build=$(realpath "$1") work=$2
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
rm -rf "$work"
mkdir -p "$work" && cd "$work" || exit 1
export PATH=$build/bin:$PATH
failed=0
count=0

# run EXPECTED COMMAND
run() {
    local code=0
    bash -c "$2" >log 2>&1 || code=$?
    count=$((count + 1))
    if [[ $code != "$1" ]]; then
        echo "exit code $code instead of $1: $2"
        tail -5 log
        failed=1
    fi
}

pointplane-simulate corner -o in.rawlog --duration 2.5 --size 320x240 --quiet >log 2>&1 || { cat log; exit 1; }
for name in a b; do
    ln -s in.rawlog $name.rawlog
    ln -s in.groundtruth.txt $name.groundtruth.txt
done
cp "$root"/config*.ini .
"$root/tests/packaging/make_recordings.py" .
ln -s in.groundtruth.txt GT
ln -s in.groundtruth.txt groundtruth.txt
pointplane-odometry in.rawlog -o EST.rawlog --only-poses --since 31 --trajectory-frame robot \
    --trajectory robot.txt --quiet >log 2>&1 || { cat log; exit 1; }
pointplane-odometry in.rawlog --trajectory EST --quiet >log 2>&1 || { cat log; exit 1; }
for name in A B C; do
    ln -s EST $name
done
if [[ -n ${POINTPLANE_DATA:-} ]]; then
    # Two seconds of it are enough here.
    mkdir rgbd_dataset_freiburg1_xyz
    ln -s "$POINTPLANE_DATA"/tum_fr1_xyz_part/* rgbd_dataset_freiburg1_xyz/
    for list in rgb depth; do
        rm rgbd_dataset_freiburg1_xyz/$list.txt
        head -75 "$POINTPLANE_DATA/tum_fr1_xyz_part/$list.txt" >rgbd_dataset_freiburg1_xyz/$list.txt
    done
fi

# commands PAGE: of README the first column of its table; of all pages the indented lines. A backslash at
# the end goes on, and a loop is one command. pointplane-camera and pointplane-status are comments of
# rawlogs.
commands() {
    sed -nE 's/^\| `(pointplane-[^`]+)`.*/\1/p' "$1"
    sed -nE 's/^    //p' "$1" | sed -E ':a; /\\$/{N; s/\\\n//; ba}; s/ #.*//' |
        sed -E '/^for /{:b; N; /\ndone$/!bb; s/; do\n */; do /; s/\n */; /g}' |
        grep -E '^(for .*)?pointplane-[a-z]+ ' | grep -vE '^pointplane-(camera|status) '
}

pages=(README docs/cameras docs/config docs/consistency docs/downstream docs/evaluation docs/grabber
    docs/paper_figures docs/rawlogs docs/simulation)
for page in "${pages[@]}"; do
    before=$count
    while read -r command; do
        case $command in
            pointplane-simulate*) run 0 "$command --duration 1.5 --size 320x240" ;;  # 18 s otherwise
            pointplane-grabber*) [[ -e /dev/bus/usb ]] || run 3 "$command" ;;  # no camera here
            pointplane-convert\ tum* | *fr1_xyz*) [[ -z ${POINTPLANE_DATA:-} ]] || run 0 "$command" ;;
            pointplane-convert\ bag*) [[ $(bash -c "$command" 2>&1) == *"built without"* ]] || run 0 "$command" ;;
            # Minutes, of sequences that are not here; tests/lab has it.
            pointplane-lab*) ;;
            *) run 0 "$command" ;;
        esac
    done < <(commands "$root/$page.md")
    ((count > before)) || [[ -z ${POINTPLANE_DATA:-} ]] || { echo "$page: no commands"; failed=1; }
done

# Each tutorial from its beginning, in a folder of its own.
for tutorial in "$root"/docs/tutorials/*.md; do
    name=$(basename "$tutorial" .md)
    mkdir "$name" && cd "$name" || exit 1
    if grep -q rgbd_dataset_freiburg1_xyz "$tutorial"; then
        [[ -n ${POINTPLANE_DATA:-} ]] || { cd ..; continue; }
        ln -s ../rgbd_dataset_freiburg1_xyz .
    fi
    before=$count
    while read -r command; do
        case $command in
            pointplane-grabber*) [[ -e /dev/bus/usb ]] || run 3 "$command" ;;  # no camera here
            pointplane-* | printf*) run 0 "$command" ;;
            *) ! command -v "${command%% *}" >/dev/null || run 0 "$command" ;;  # MRPT's own
        esac
    done < <(sed -nE 's/^    //p' "$tutorial")
    ((count > before)) || { echo "$name: no commands"; failed=1; }
    cd ..
done

((count >= 9)) || { echo "only $count commands found"; failed=1; }
exit "$failed"
