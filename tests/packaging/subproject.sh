#!/usr/bin/env bash
# Another project has pointplane as a part: it gets the libraries and nothing else, also if it compiles for
# another system. Only configured. subproject.sh BUILD WORK
set -euo pipefail
build=$1 work=$2
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
rm -rf "$work"
mkdir -p "$work"
cat >"$work/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.22)
project(whole LANGUAGES CXX)
add_custom_target(products ALL)
add_subdirectory(${POINTPLANE} pointplane)
add_executable(consumer ${POINTPLANE}/tests/consumer/main.cpp)
target_link_libraries(consumer PRIVATE pointplane::mrpt_io)
foreach(target ${ABSENT})
  if(TARGET ${target})
    message(FATAL_ERROR "target ${target} in another project")
  endif()
endforeach()
if(CMAKE_BUILD_TYPE)
  message(FATAL_ERROR "another project is built as ${CMAKE_BUILD_TYPE}")
endif()
END
# cached NAME: its value in the build folder.
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }

# configure FOLDER ABSENT OPTION...
configure() {
    cmake -S "$work" -B "$work/$1" -G "$(cached CMAKE_GENERATOR)" -DPOINTPLANE="$root" -DABSENT="$2" \
        -DCMAKE_CXX_COMPILER="$(cached CMAKE_CXX_COMPILER)" "${@:3}" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
}
configure libraries "pointplane-odometry;pointplane_python;pointplane_test_support"
! grep config.ini "$work/libraries/pointplane/cmake_install.cmake" ||
    { echo "files of the programs are installed by another project"; exit 1; }
[[ ! -e $work/libraries/CPackConfig.cmake ]] || { echo "packages are made by another project"; exit 1; }
# Manual pages are what the programs print.
configure cross pointplane-odometry-manual -DCMAKE_SYSTEM_NAME=Linux -DPOINTPLANE_BUILD_APPS=ON
