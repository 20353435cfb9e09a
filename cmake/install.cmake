# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# cmake --install: the library, its headers, the program and what find_package(limen) needs.
include(CMakePackageConfigHelpers)

set(LIMEN_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/limen)
install(TARGETS limen EXPORT limenTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS limen_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(LIMEN_BUILD_IFC)
  install(TARGETS limen_ifc RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/limen)
endif()
# Headers that need the libraries we build with, but do not ask of users, stay at home.
install(DIRECTORY src/limen DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h"
        PATTERN "cli" EXCLUDE PATTERN "simulate" EXCLUDE PATTERN "json_values.h" EXCLUDE
        PATTERN "test_support.h" EXCLUDE PATTERN "synthetic_*.h" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/limen/base/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limen/base)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT limenTargets NAMESPACE limen:: DESTINATION ${LIMEN_PACKAGE_DIR})
configure_package_config_file(cmake/limenConfig.cmake.in ${PROJECT_BINARY_DIR}/limenConfig.cmake
                              INSTALL_DESTINATION ${LIMEN_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limenConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/limenConfig.cmake ${PROJECT_BINARY_DIR}/limenConfigVersion.cmake
        DESTINATION ${LIMEN_PACKAGE_DIR})
