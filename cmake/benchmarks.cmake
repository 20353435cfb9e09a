# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# One program per file of benchmarks/; those with their own main are named *_main.cpp.
find_package(benchmark REQUIRED)
file(GLOB LIMEN_BENCHMARKS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmarks/*.cpp)
add_custom_target(benchmarks)
foreach(source IN LISTS LIMEN_BENCHMARKS)
  get_filename_component(name ${source} NAME_WE)
  string(REGEX REPLACE "_main$" "" target bench_${name})
  add_executable(${target} ${source})
  target_link_libraries(${target} PRIVATE limen limen_options Boost::headers fmt::fmt nlohmann_json::nlohmann_json
    CLI11::CLI11 $<$<BOOL:${LIMEN_BUILD_SIMULATOR}>:limen_simulate>)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  # The precompiled header is the library's: it was made for code in any place (-fPIC), not for a program's (-fPIE).
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${target} PRIVATE -fPIC)
  target_precompile_headers(${target} REUSE_FROM limen)
  if(NOT source MATCHES "_main\\.cpp$")
    target_link_libraries(${target} PRIVATE benchmark::benchmark_main)
  endif()
  add_dependencies(benchmarks ${target})
endforeach()
