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
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/installed)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer ${CONFIG} ${RAWLOG})
message(STATUS "${output}")
if(NOT output MATCHES "first" OR NOT output MATCHES "sigma x [0-9]")
  message(FATAL_ERROR "unexpected output of the consumer:\n${output}")
endif()
