# marey_unity(TARGET GROUP MAX SOURCE ...)
#
# With MAREY_UNITY the sources of a group are compiled together, up to MAX in one unit. The cost is in the headers (Eigen, OpenCV, fmt, the standard
# library) and in what is instantiated from them, and one source needs nearly as much of that as all: seven folders of 38 sources took 70 s of processor
# time one by one and 48 s as one unit. A group is a top folder with its subfolders, or a program. Where sources instantiate much, units are smaller: 21 of
# calibrate in one unit need 2 GB. A source with its own flags is compiled alone. Therefore names in unnamed namespaces are distinct within a folder, and
# no source has `using namespace` at its top.
# A precompiled header of the common ones (Eigen, OpenCV, fmt, core) was tried in addition: it is 205 MB, and a unit takes as long with it (on a busy machine,
# evaluate 9.2 s of processor time against 9.7) or longer (assign 8.6 against 4.5), because reading it costs what parsing the needed part does.
# CMake's own unity builds name their sources by the path of the checkout, so that two checkouts cannot share a compiler cache; these do not.
function(marey_unity target group max)
  if(NOT MAREY_UNITY)
    return()
  endif()
  get_property(sources GLOBAL PROPERTY MAREY_UNITY_${target}_${group})
  if(NOT sources)  # written when all sources of the group and their flags are known
    cmake_language(EVAL CODE "cmake_language(DEFER DIRECTORY [[${PROJECT_SOURCE_DIR}]] CALL marey_write_units ${target} ${group} ${max})")
  endif()
  foreach(source IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH source)
    set_property(GLOBAL APPEND PROPERTY MAREY_UNITY_${target}_${group} ${source})
  endforeach()
endfunction()

function(marey_write_units target group max)
  get_property(sources GLOBAL PROPERTY MAREY_UNITY_${target}_${group})
  set(together "")
  foreach(source IN LISTS sources)
    get_source_file_property(options ${source} TARGET_DIRECTORY ${target} COMPILE_OPTIONS)
    get_source_file_property(definitions ${source} TARGET_DIRECTORY ${target} COMPILE_DEFINITIONS)
    if(NOT options AND NOT definitions)
      list(APPEND together ${source})
    endif()
  endforeach()
  list(LENGTH together count)
  if(count EQUAL 0)
    return()
  endif()
  # Units of equal size: with a maximum of twelve, thirteen sources become seven and six, not twelve and one.
  math(EXPR units "(${count} + ${max} - 1) / ${max}")
  math(EXPR size "(${count} + ${units} - 1) / ${units}")
  set_source_files_properties(${together} TARGET_DIRECTORY ${target} PROPERTIES HEADER_FILE_ONLY ON)
  set(folder ${PROJECT_BINARY_DIR}/units)
  math(EXPR last "${units} - 1")
  foreach(unit RANGE ${last})
    math(EXPR begin "${unit} * ${size}")
    list(SUBLIST together ${begin} ${size} sources)
    set(file ${folder}/${target}_${group}_${unit}.cpp)
    set(text "")
    foreach(source IN LISTS sources)
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${folder} OUTPUT_VARIABLE name)
      string(APPEND text "#include \"${name}\"\n")
    endforeach()
    file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
    target_sources(${target} PRIVATE ${file})
    marey_sanitize_unit(${target} ${file} ${sources})
  endforeach()
endfunction()

# With MAREY_SANITIZE_FOLDERS a unit is built with the sanitizers if one of its sources is in these folders. All others are compiled as in a release, so
# that a compiler cache has them and tests run nearly as fast. Eigen would allocate differently under the address sanitizer than in the units without it;
# a definition states that memory is aligned, as it is in both.
function(marey_sanitize_unit target unit)
  foreach(source IN LISTS ARGN)
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    cmake_path(GET source PARENT_PATH folder)
    if(folder IN_LIST MAREY_SANITIZE_FOLDERS)
      set_source_files_properties(${unit} TARGET_DIRECTORY ${target} PROPERTIES COMPILE_OPTIONS
        "-O1;-g1;-U_FORTIFY_SOURCE;-fsanitize=${MAREY_SANITIZE};-fno-omit-frame-pointer;-fno-sanitize-recover=all;-DEIGEN_MALLOC_ALREADY_ALIGNED=1;-Wno-error;-Wno-maybe-uninitialized")
      return()
    endif()
  endforeach()
endfunction()

# Folders whose subfolders are as large as other folders: each subfolder is a separate group, of smaller units.
set(MAREY_LARGE_FOLDERS calibrate format solve)

# marey_module(NAME [SOURCES ...] [VIDEO_SOURCES ...] [TESTS ...] [TEST_LIBRARIES ...])
#
# Adds one folder of src/marey, "detect" or "detect/markers", to the library. SOURCES go into `marey`; VIDEO_SOURCES, which need FFmpeg, go into
# `marey_video`, because that loads a hundred shared libraries at every start. Without SOURCES, all sources of the folder that are not tests are added: a
# new format needs no change here. TESTS become one program, NAME_test.
function(marey_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;VIDEO_SOURCES;TESTS;TEST_LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "marey_module(${name}): what is ${arg_UNPARSED_ARGUMENTS}?")
  endif()
  if(NOT arg_SOURCES AND NOT arg_VIDEO_SOURCES)
    file(GLOB arg_SOURCES RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" CONFIGURE_DEPENDS "*.cpp")
    list(FILTER arg_SOURCES EXCLUDE REGEX "_test\\.cpp$")
  endif()
  list(TRANSFORM arg_SOURCES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  list(TRANSFORM arg_VIDEO_SOURCES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  target_sources(marey PRIVATE ${arg_SOURCES})
  target_sources(marey_video PRIVATE ${arg_VIDEO_SOURCES})
  string(REGEX MATCH "^[^/]+" group ${name})
  set(max 24)
  if(group IN_LIST MAREY_LARGE_FOLDERS)
    string(REPLACE "/" "_" group ${name})
    set(max 12)
  endif()
  marey_unity(marey ${group} ${max} ${arg_SOURCES})
  marey_unity(marey_video ${group} ${max} ${arg_VIDEO_SOURCES})
  if(MAREY_TESTS AND arg_TESTS)
    string(REPLACE "/" "." prefix ${name})
    string(REPLACE "/" "_" name ${name})
    add_executable(${name}_test ${arg_TESTS})
    target_link_libraries(${name}_test PRIVATE marey_video GTest::gtest_main marey_warnings marey_test_support ${arg_TEST_LIBRARIES})
    # Two thirds of the compile time; slow code is in the library. At -O1 GCC reports an empty std::optional as a use of an unset value.
    target_compile_options(${name}_test PRIVATE $<$<CONFIG:Release>:-O1> $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Wno-maybe-uninitialized>)
    marey_unity(${name}_test all 12 ${arg_TESTS})
    gtest_discover_tests(${name}_test TEST_PREFIX "${prefix}." DISCOVERY_TIMEOUT 60 DISCOVERY_MODE PRE_TEST)
  endif()
endfunction()

# Flags of every target of the project: warnings, and the sanitizers if requested.
add_library(marey_warnings INTERFACE)
target_compile_options(marey_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       $<$<BOOL:${MAREY_WERROR}>:-Werror>
                       # A source included by a unit is not a header: a member may have a type of its unnamed namespace.
                       $<$<AND:$<BOOL:${MAREY_UNITY}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
                       # A name of one source may hide a name of another one in the unit.
                       $<$<AND:$<BOOL:${MAREY_UNITY}>,$<CXX_COMPILER_ID:Clang>>:-Wno-shadow>
                       # libstdc++ 12's stable_sort and stable_partition call deprecated functions, and clang reports that.
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>)
# By default GCC collects garbage from 128 MB on, again and again in units that need a gigabyte. With a threshold of half a gigabyte, a unit of 0.5 GB took
# 9.1 s of processor time instead of 9.9, and 0.6 GB; the largest (calibrate) needs 2 GB.
if(MAREY_UNITY)
  target_compile_options(marey_warnings INTERFACE "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=524288 --param ggc-min-expand=200>")
endif()
# A release is hardened: an access outside of a buffer or container ends the program. Not with sanitizers, which detect more.
if(NOT MAREY_SANITIZE OR MAREY_SANITIZE_FOLDERS)
  target_compile_options(marey_warnings INTERFACE $<$<CONFIG:Release>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3;-fstack-protector-strong;-D_GLIBCXX_ASSERTIONS>)
endif()
if(MAREY_SANITIZE_FOLDERS)
  add_link_options(-fsanitize=${MAREY_SANITIZE})
elseif(MAREY_SANITIZE)  # The presets with GCC's sanitizers let warnings pass: it gives false ones there, as its manual says.
  add_compile_options(-fsanitize=${MAREY_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${MAREY_SANITIZE})
  if(MAREY_FUZZ_STEERED)  # not where tests run: every comparison calls
    add_compile_options(-fsanitize=fuzzer-no-link)
  endif()
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
  if(MAREY_SANITIZE STREQUAL "thread")
    target_sources(marey_test_support INTERFACE "${PROJECT_SOURCE_DIR}/tests/support/opencv_on_one_thread.cpp")
  endif()
endif()
