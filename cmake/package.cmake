# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# cpack -G DEB: one package with the program, its manual page and completions, the helper and the library.
set(CPACK_PACKAGE_NAME limen)
set(CPACK_PACKAGE_VENDOR "The limen authors")
set(CPACK_PACKAGE_CONTACT "The limen authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "Finds how two laser scans of one building fit together, and where in a building model \
a scan was taken; says so where several poses fit. Program, manual page, completions and C++ library.")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# The libraries the programs are linked with, found by dpkg-shlibdeps.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# It does not find this one, which tells nothing of its libraries.
if(LIMEN_BUILD_IFC)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS libifcplusplus)
endif()
# What knows coordinate systems by their numbers; found when the program runs.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libproj25)
# What --engine dask needs, and what builds with find_package(limen) need besides.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-distributed, python3-cryptography, libeigen3-dev, libfmt-dev, zlib1g-dev, libpugixml-dev, libpolyclipping-dev, libssl-dev")
set(CPACK_GENERATOR TGZ)
include(CPack)
