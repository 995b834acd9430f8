# Installs the build tree, builds the consumer against it and runs it on a rawlog.
# cmake -DBUILD_DIR=... -DSOURCE_DIR=... -DWORK_DIR=... -DRAWLOG=... -DCONFIG=... -DCXX=...
#       -DGENERATOR=... -P run.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed with ${code}: ${ARGN}\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/installed)

# expect_find(REGEX COMPONENT [NAME=VALUE...]): what find_package() finds, with these variables in the environment.
file(WRITE ${WORK_DIR}/find/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.22)
project(find LANGUAGES CXX)
find_package(pointplane QUIET COMPONENTS ${COMPONENT})
message("found ${pointplane_FOUND}: ${pointplane_NOT_FOUND_MESSAGE}")
]])
function(expect_find regex component)
  run(${CMAKE_COMMAND} -E env ${ARGN} ${CMAKE_COMMAND} -S ${WORK_DIR}/find -B ${WORK_DIR}/find/build
      -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/installed -DCOMPONENT=${component})
  if(NOT output MATCHES "${regex}")
    message(FATAL_ERROR "find_package() of component ${component}, not \"${regex}\":\n${output}")
  endif()
endfunction()
expect_find("found 0: .*libdeflate" mrpt_io PKG_CONFIG_PATH= PKG_CONFIG_LIBDIR=${WORK_DIR}/find)
expect_find("found 0" nothing)
expect_find("found 1" mrpt_io)

run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/installed)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
set(consumer ${WORK_DIR}/build/consumer)
# With its frames in CSensoryFrames, too.
run(${WORK_DIR}/installed/bin/pointplane-odometry ${RAWLOG} -o ${WORK_DIR}/framed.rawlog --format1 --quiet)
foreach(rawlog ${RAWLOG} ${WORK_DIR}/framed.rawlog)
  run(${consumer} ${CONFIG} ${rawlog})
  message(STATUS "${output}")
  if(NOT output MATCHES "first" OR NOT output MATCHES "sigma x [0-9]")
    message(FATAL_ERROR "unexpected output of the consumer of ${rawlog}:\n${output}")
  endif()
endforeach()
execute_process(COMMAND ${consumer} ${CONFIG} none.rawlog RESULT_VARIABLE code ERROR_VARIABLE error)
if(NOT code EQUAL 2 OR NOT error MATCHES "consumer: .*none.rawlog[^\n]*\n$")
  message(FATAL_ERROR "without a rawlog, the consumer ends with ${code}: ${error}")
endif()

# The lines of README compile as they are written.
file(READ ${SOURCE_DIR}/../../README.md readme)
if(NOT readme MATCHES "```cpp\n(#include [^\n]*\n)([^`]*)```")
  message(FATAL_ERROR "README.md has no C++")
endif()
file(COPY ${SOURCE_DIR}/CMakeLists.txt DESTINATION ${WORK_DIR}/readme)
file(WRITE ${WORK_DIR}/readme/main.cpp "#include <iostream>\n${CMAKE_MATCH_1}"
     "void use(const mrpt::obs::CObservation3DRangeScan& scan)\n{\n${CMAKE_MATCH_2}}\nint main() { use({}); }\n")
run(${CMAKE_COMMAND} -S ${WORK_DIR}/readme -B ${WORK_DIR}/readme/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/installed)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/readme/build)
