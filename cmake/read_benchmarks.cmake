# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# Where the benchmarks are not built, a test has the compiler read them, so that none stops compiling unnoticed.
find_package(benchmark QUIET)
find_path(NANOFLANN_INCLUDE_DIR nanoflann.hpp)
file(GLOB LIMEN_BENCHMARKS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmarks/*.cpp)
if(NOT benchmark_FOUND)
  list(FILTER LIMEN_BENCHMARKS INCLUDE REGEX "_main\\.cpp$")
endif()
if(NOT NANOFLANN_INCLUDE_DIR)
  list(FILTER LIMEN_BENCHMARKS EXCLUDE REGEX "/icp_floor_main\\.cpp$")
endif()
# Nothing is made of them: each is read again whenever the target is asked for.
add_library(read_benchmarks OBJECT EXCLUDE_FROM_ALL ${LIMEN_BENCHMARKS})
target_link_libraries(read_benchmarks PRIVATE limen limen_simulate limen_options fmt::fmt nlohmann_json::nlohmann_json
  CLI11::CLI11 $<TARGET_NAME_IF_EXISTS:benchmark::benchmark>)
target_include_directories(read_benchmarks PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_compile_options(read_benchmarks PRIVATE -fsyntax-only)
target_precompile_headers(read_benchmarks REUSE_FROM limen)

add_test(NAME benchmarks_compile
         COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target read_benchmarks --parallel 1)
# It is among the longest: it is to begin early.
set_tests_properties(benchmarks_compile PROPERTIES LABELS acceptance COST 100 TIMEOUT 600)
