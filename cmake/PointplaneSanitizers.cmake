# Instrumentation of everything that is built, the tests included. docs/robustness.md says how it is used.
set(POINTPLANE_SANITIZE "" CACHE STRING "Sanitizers: address (with undefined behaviour) or thread")
option(POINTPLANE_BUILD_FUZZERS "Build the libFuzzer targets in tests/fuzz (needs Clang)" OFF)
option(POINTPLANE_COVERAGE "Count the executed lines, for tools/coverage.sh (needs GCC)" OFF)

if(POINTPLANE_SANITIZE STREQUAL "address")
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=address,undefined)
elseif(POINTPLANE_SANITIZE STREQUAL "thread")
  add_compile_options(-fsanitize=thread)
  add_link_options(-fsanitize=thread)
elseif(POINTPLANE_SANITIZE)
  message(FATAL_ERROR "POINTPLANE_SANITIZE=${POINTPLANE_SANITIZE} is neither address nor thread")
endif()
if(POINTPLANE_SANITIZE)
  # Line numbers in reports; the containers' own checks come for little.
  add_compile_options(-g1 -fno-omit-frame-pointer)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()

if(POINTPLANE_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "POINTPLANE_BUILD_FUZZERS needs Clang: -DCMAKE_CXX_COMPILER=clang++")
  endif()
  # Without the operands of comparisons: they double the time of all matrix code, and the seeds hold
  # the words that they would find.
  add_compile_options(-fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp)
endif()

if(POINTPLANE_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()
