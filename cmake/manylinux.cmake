# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# Toolchain for scripts/wheel: this machine's g++ against the C library of Debian 11 in LIMEN_SYSROOT/debian11, and the
# libraries built in LIMEN_SYSROOT. What is made needs the C library and libgcc_s of where it runs, and shows no symbols of C++.
set(CMAKE_C_COMPILER gcc)
set(CMAKE_CXX_COMPILER g++)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LIMEN_SYSROOT)
set(CMAKE_SYSROOT ${LIMEN_SYSROOT}/debian11)
set(CMAKE_FIND_ROOT_PATH ${LIMEN_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ZLIB_USE_STATIC_LIBS ON)
set(OPENSSL_USE_STATIC_LIBS ON)
foreach(kind IN ITEMS EXE MODULE SHARED)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT "-B${CMAKE_SYSROOT}/usr/lib/x86_64-linux-gnu -static-libstdc++ -Wl,--exclude-libs,ALL -s \
${LIMEN_SYSROOT}/manylinux.o")
endforeach()
