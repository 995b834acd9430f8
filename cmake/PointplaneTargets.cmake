# Warnings, standard and install rules in one place.
include(GNUInstallDirs)

# All that is installed: programs, libraries and, where they can be made, manual pages and the Python
# module. ./demo builds it, so that `cmake --install` works after it.
add_custom_target(pointplane_products ALL)

set(POINTPLANE_TEST_TIMEOUT 300 CACHE STRING "Seconds that one test may take")

function(pointplane_target_defaults target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # Clang counts signs among the conversions, GCC does not: the same for both.
    target_compile_options(${target} PRIVATE -Wno-sign-conversion)
  endif()
endfunction()

# pointplane_bind_now(TARGET): addresses of functions are found at the start and are read-only after it, as
# Debian asks of programs.
function(pointplane_bind_now target)
  if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
    target_link_options(${target} PRIVATE LINKER:-z,relro,-z,now)
  endif()
endfunction()

# pointplane_add_library(NAME SOURCES a.cpp ... [LINK lib ...] [LINK_PRIVATE lib ...])
# Target pointplane_NAME, alias pointplane::NAME, headers in include/.
function(pointplane_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LINK_PRIVATE" ${ARGN})
  set(target pointplane_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(pointplane::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${ARG_LINK} PRIVATE ${ARG_LINK_PRIVATE})
  pointplane_target_defaults(${target})
  install(TARGETS ${target} EXPORT pointplaneTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
  add_dependencies(pointplane_products ${target})
endfunction()

# pointplane_add_manual(NAME): the manual pages of pointplane-NAME and its subcommands out of their --help,
# and completion of its command line in bash.
find_program(POINTPLANE_HELP2MAN help2man)
function(pointplane_add_manual name)
  set(program pointplane-${name})
  install(FILES ${PROJECT_SOURCE_DIR}/packaging/completion.bash COMPONENT tools
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
  # help2man runs the program.
  if(NOT POINTPLANE_HELP2MAN OR POINTPLANE_SANITIZE OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  set(page ${CMAKE_CURRENT_BINARY_DIR}/${program}.1)
  set(pages_of_commands ${CMAKE_CURRENT_BINARY_DIR}/${program}_commands)
  add_custom_command(
    OUTPUT ${page}
    COMMAND ${PROJECT_SOURCE_DIR}/packaging/manual_page.sh ${POINTPLANE_HELP2MAN}
            $<TARGET_FILE:${program}> ${PROJECT_VERSION} ${page} ${pages_of_commands}
    DEPENDS ${program} ${PROJECT_SOURCE_DIR}/packaging/manual_page.sh
    VERBATIM)
  add_custom_target(${program}-manual DEPENDS ${page})
  add_dependencies(pointplane_products ${program}-manual)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
  install(DIRECTORY ${pages_of_commands}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
endfunction()

# pointplane_add_app(NAME SOURCES a.cpp ... LINK lib ...): executable pointplane-NAME.
function(pointplane_add_app name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  set(target pointplane-${name})
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_LINK})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_compile_definitions(${target} PRIVATE POINTPLANE_VERSION="${PROJECT_VERSION}")
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  pointplane_target_defaults(${target})
  pointplane_bind_now(${target})
  install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  add_dependencies(pointplane_products ${target})
  pointplane_add_manual(${name})
endfunction()

# pointplane_add_tests(LIB [NAME name] CONCEPTS a b ... [LINK lib ...] [INCLUDE dir ...] [DEFINE X=1 ...]
# [LABELS label ...] [REAL_TIME regex]): tests/LIB/a_unittest.cpp and so on as one gtest binary, test_LIB or
# test_LIB_name; each TEST is one ctest entry named LIB/Suite.name, labelled LIB and what LABELS adds.
# REAL_TIME: tests whose names match run with no other test beside them.
function(pointplane_add_tests lib)
  cmake_parse_arguments(ARG "" "NAME;REAL_TIME" "CONCEPTS;LINK;INCLUDE;DEFINE;LABELS" ${ARGN})
  set(target test_${lib})
  if(ARG_NAME)
    string(APPEND target _${ARG_NAME})
  endif()
  list(TRANSFORM ARG_CONCEPTS APPEND _unittest.cpp OUTPUT_VARIABLE sources)
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE ${ARG_LINK} pointplane_test_support GTest::gtest GTest::gmock GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${ARG_INCLUDE})
  target_compile_definitions(${target} PRIVATE ${ARG_DEFINE})
  pointplane_target_defaults(${target})
  # Libraries are compiled as they are shipped. The tests' own sources compile a quarter faster this way.
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  # __FILE__ without the clone's folder: messages are shorter, and ccache finds what another clone compiled.
  target_compile_options(${target} PRIVATE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Tests are classes whose base is in a nameless namespace, which GCC minds in a source that others include.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  gtest_discover_tests(${target} TEST_PREFIX "${lib}/" DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT ${POINTPLANE_TEST_TIMEOUT} LABELS ${lib})
  if(ARG_LABELS)
    # gtest_discover_tests() splits lists: a second label would be taken for the next property.
    set(labels_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_labels.cmake)
    file(WRITE ${labels_file}
         "foreach(test IN LISTS ${target}_TESTS)\n"
         "  set_tests_properties(\${test} PROPERTIES LABELS \"${lib};${ARG_LABELS}\")\n"
         "endforeach()\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels_file})
  endif()
  if(ARG_REAL_TIME)
    set(serial_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_serial.cmake)
    file(WRITE ${serial_file}
         "set(tests \${${target}_TESTS})\n"
         "list(FILTER tests INCLUDE REGEX \"${ARG_REAL_TIME}\")\n"
         "if(tests)\n"
         "  set_tests_properties(\${tests} PROPERTIES RUN_SERIAL ON)\n"
         "endif()\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${serial_file})
  endif()
endfunction()
