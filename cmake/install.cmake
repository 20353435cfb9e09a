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
        PATTERN "cli" EXCLUDE PATTERN "simulate" EXCLUDE PATTERN "json_values.h" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/limen/base/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limen/base)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT limenTargets NAMESPACE limen:: DESTINATION ${LIMEN_PACKAGE_DIR})
configure_package_config_file(cmake/limenConfig.cmake.in ${PROJECT_BINARY_DIR}/limenConfig.cmake
                              INSTALL_DESTINATION ${LIMEN_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limenConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/limenConfig.cmake ${PROJECT_BINARY_DIR}/limenConfigVersion.cmake
        DESTINATION ${LIMEN_PACKAGE_DIR})

# The manual page and the shells' completions are printed by the program itself, so that they cannot differ
# from it.
set(LIMEN_PRINTED_DIR ${PROJECT_BINARY_DIR}/printed)
file(MAKE_DIRECTORY ${LIMEN_PRINTED_DIR})
set(LIMEN_PRINTED ${LIMEN_PRINTED_DIR}/limen.1 ${LIMEN_PRINTED_DIR}/limen.bash ${LIMEN_PRINTED_DIR}/_limen
    ${LIMEN_PRINTED_DIR}/limen.fish)
add_custom_command(OUTPUT ${LIMEN_PRINTED}
  COMMAND limen_program man > ${LIMEN_PRINTED_DIR}/limen.1
  COMMAND limen_program completion bash > ${LIMEN_PRINTED_DIR}/limen.bash
  COMMAND limen_program completion zsh > ${LIMEN_PRINTED_DIR}/_limen
  COMMAND limen_program completion fish > ${LIMEN_PRINTED_DIR}/limen.fish
  DEPENDS limen_program COMMENT "Printing the manual page and the completions")
add_custom_target(limen_printed ALL DEPENDS ${LIMEN_PRINTED})
install(FILES ${LIMEN_PRINTED_DIR}/limen.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${LIMEN_PRINTED_DIR}/limen.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME limen)
install(FILES ${LIMEN_PRINTED_DIR}/_limen DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${LIMEN_PRINTED_DIR}/limen.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
