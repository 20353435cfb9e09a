# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# limen_fuzz: the readers under libFuzzer, with address and undefined-behaviour sanitizers. Needs clang++.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "The fuzzers need clang++: configure with -DCMAKE_CXX_COMPILER=clang++-14")
endif()
add_executable(limen_fuzz tests/fuzz/fuzz_main.cpp tests/fuzz/readers.cpp)
target_include_directories(limen_fuzz PRIVATE ${PROJECT_SOURCE_DIR}/tests/fuzz)
target_link_libraries(limen_fuzz PRIVATE limen limen_cli limen_options)
target_link_options(limen_fuzz PRIVATE -fsanitize=fuzzer)
