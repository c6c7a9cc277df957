# Installs the libraries, their headers, the program and a CMake package: find_package(marey). Components are the Debian packages' (MareyPackages).
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # a package needs no tests built
install(TARGETS marey marey_video EXPORT marey_targets)
install(TARGETS marey_cli RUNTIME COMPONENT program)
# What serves tests, and what shows a library that users need not have, stays here.
install(DIRECTORY src/marey TYPE INCLUDE FILES_MATCHING PATTERN "*.h"
        PATTERN "*_test.h" EXCLUDE PATTERN "*_testing.h" EXCLUDE PATTERN "filter_invariants.h" EXCLUDE PATTERN "rig_section.h" EXCLUDE
        PATTERN "svg.h" EXCLUDE PATTERN "pitch_svg.h" EXCLUDE PATTERN "xml_text.h" EXCLUDE PATTERN "kernel_targets.h" EXCLUDE PATTERN
        "locked_executor.h" EXCLUDE PATTERN "whole_writes.h" EXCLUDE)
install(EXPORT marey_targets NAMESPACE marey:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/marey)
configure_package_config_file(cmake/marey-config.cmake.in marey-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/marey)
write_basic_package_version_file(marey-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/marey-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/marey-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/marey)
