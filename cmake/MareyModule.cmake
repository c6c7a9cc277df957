# marey_module(NAME [SOURCES ...] [VIDEO_SOURCES ...] [TESTS ...] [TEST_LIBRARIES ...])
#
# Adds one room of src/marey, "detect" or "detect/markers", to the library. SOURCES go into `marey`; VIDEO_SOURCES, which need FFmpeg, go into
# `marey_video`, because loading that costs a hundred shared libraries at every start. Where SOURCES are left out they are all of the folder's that are
# no tests: a room of formats takes a new one without being told. TESTS become one program, NAME_test.
function(marey_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;VIDEO_SOURCES;TESTS;TEST_LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "marey_module(${name}): what is ${arg_UNPARSED_ARGUMENTS}?")
  endif()
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" CONFIGURE_DEPENDS "*.cpp")
    list(FILTER arg_SOURCES EXCLUDE REGEX "_test\\.cpp$")
  endif()
  list(TRANSFORM arg_SOURCES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  list(TRANSFORM arg_VIDEO_SOURCES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  target_sources(marey PRIVATE ${arg_SOURCES})
  target_sources(marey_video PRIVATE ${arg_VIDEO_SOURCES})
  if(MAREY_TESTS AND arg_TESTS)
    string(REPLACE "/" "." prefix ${name})
    string(REPLACE "/" "_" name ${name})
    add_executable(${name}_test ${arg_TESTS})
    target_link_libraries(${name}_test PRIVATE marey_video GTest::gtest_main marey_warnings marey_test_support ${arg_TEST_LIBRARIES})
    gtest_discover_tests(${name}_test TEST_PREFIX "${prefix}." DISCOVERY_TIMEOUT 60 DISCOVERY_MODE PRE_TEST)
  endif()
endfunction()

# What every target of ours is compiled with: warnings, and the sanitizers where asked for.
add_library(marey_warnings INTERFACE)
target_compile_options(marey_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       $<$<BOOL:${MAREY_WERROR}>:-Werror>
                       # libstdc++ 12's own stable_sort and stable_partition call what it has deprecated, and clang tells.
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>)
if(MAREY_SANITIZE)  # The presets with sanitizers let warnings pass: GCC gives false ones there, as its manual says.
  add_compile_options(-fsanitize=${MAREY_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${MAREY_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # GCC 12 takes the checks themselves for uses of what is not set
    target_compile_options(marey_warnings INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
if(MAREY_TESTS)
  include(GoogleTest)
  enable_testing()
  # For "support/...". Where the checkout lies is known to this one object, so that a compiler's cache serves all the others.
  add_library(marey_test_support STATIC "${PROJECT_SOURCE_DIR}/tests/support/data.cpp")
  target_compile_features(marey_test_support PUBLIC cxx_std_20)
  target_include_directories(marey_test_support PUBLIC "${PROJECT_SOURCE_DIR}/tests")
  target_compile_definitions(marey_test_support PRIVATE MAREY_ROOT="${PROJECT_SOURCE_DIR}")
  target_link_libraries(marey_test_support PRIVATE marey_warnings)
endif()
