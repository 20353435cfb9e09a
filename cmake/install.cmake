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
install(FILES src/dask/limen_dask.py DESTINATION ${CMAKE_INSTALL_DATADIR}/limen)
# The public headers are those that limen/limen.h names; what they include goes with them, nothing else.
install(CODE "set(LIMEN_HEADER_ROOT \"${PROJECT_SOURCE_DIR}/src\")
set(LIMEN_HEADER_DESTINATION \"${CMAKE_INSTALL_INCLUDEDIR}\")
include(\"${PROJECT_SOURCE_DIR}/cmake/install_headers.cmake\")")
install(FILES ${PROJECT_BINARY_DIR}/generated/limen/base/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limen/base)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT limenTargets NAMESPACE limen:: DESTINATION ${LIMEN_PACKAGE_DIR})
configure_package_config_file(cmake/limenConfig.cmake.in ${PROJECT_BINARY_DIR}/limenConfig.cmake
                              INSTALL_DESTINATION ${LIMEN_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limenConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/limenConfig.cmake ${PROJECT_BINARY_DIR}/limenConfigVersion.cmake
        DESTINATION ${LIMEN_PACKAGE_DIR})

if(WIN32)
  return()  # no manual page, no completions
endif()
# The manual page and the shells' completions are printed by the program itself, so that they cannot differ
# from it; a part of building it, so that whatever has the program can be installed.
set(LIMEN_PRINTED_DIR ${PROJECT_BINARY_DIR}/printed)
file(MAKE_DIRECTORY ${LIMEN_PRINTED_DIR})
add_custom_command(TARGET limen_program POST_BUILD
  COMMAND limen_program man > ${LIMEN_PRINTED_DIR}/limen.1
  COMMAND limen_program completion bash > ${LIMEN_PRINTED_DIR}/limen.bash
  COMMAND limen_program completion zsh > ${LIMEN_PRINTED_DIR}/_limen
  COMMAND limen_program completion fish > ${LIMEN_PRINTED_DIR}/limen.fish
  BYPRODUCTS ${LIMEN_PRINTED_DIR}/limen.1 ${LIMEN_PRINTED_DIR}/limen.bash ${LIMEN_PRINTED_DIR}/_limen
    ${LIMEN_PRINTED_DIR}/limen.fish
  COMMENT "Printing the manual page and the completions")
install(FILES ${LIMEN_PRINTED_DIR}/limen.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${LIMEN_PRINTED_DIR}/limen.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME limen)
install(FILES ${LIMEN_PRINTED_DIR}/_limen DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${LIMEN_PRINTED_DIR}/limen.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
