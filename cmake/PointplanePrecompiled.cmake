# Headers of other projects that many sources read. They are compiled once for all tests and once for
# all programs, since reading them took longer than compiling most tests. ccache needs settings of its
# own for this, so with ccache it is left out.
if("${CMAKE_CXX_COMPILER_LAUNCHER}" MATCHES "ccache")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

# pointplane_precompile(NAME LINK lib ... HEADERS a.h ...)
# Others take them by target_precompile_headers(TARGET REUSE_FROM NAME).
function(pointplane_precompile name)
  cmake_parse_arguments(ARG "" "" "LINK;HEADERS" ${ARGN})
  list(TRANSFORM ARG_HEADERS PREPEND "<")
  list(TRANSFORM ARG_HEADERS APPEND ">")
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  file(GENERATE OUTPUT ${source} CONTENT "// Nothing: CMake wants a source beside the headers.\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
  pointplane_target_defaults(${name})
endfunction()
