#!/usr/bin/env bash
# An hour of a 30 Hz camera through grabber and odometry, ten times as fast: memory and open files at
# the beginning and at the end. tools/soak.sh [FRAMES]
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${build_packages[@]}" "${test_packages[@]}"
build test_grabber_Soak
POINTPLANE_SOAK_FRAMES=${1:-108000} "$build_dir/tests/test_grabber_Soak"
