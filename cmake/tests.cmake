# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
find_package(GTest REQUIRED)
find_package(rapidcheck REQUIRED)
include(GoogleTest)

if(NOT LIMEN_BUILD_SIMULATOR)
  message(FATAL_ERROR "The tests need the simulator: configure with -DLIMEN_BUILD_SIMULATOR=ON or -DLIMEN_BUILD_TESTS=OFF")
endif()

# What many tests include is compiled once.
set(LIMEN_TEST_HEADERS <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <algorithm> <array> <cmath> <cstdint> <filesystem>
  <functional> <memory> <optional> <string> <string_view> <utility> <vector> <fmt/format.h> <gtest/gtest.h>)

# Tests run for a minute and are compiled for many: -O1 takes a quarter off.
set(LIMEN_TEST_OPTIONS $<$<CXX_COMPILER_ID:GNU>:-O1>)

add_executable(limen_unit_tests ${LIMEN_UNIT_TESTS})
target_compile_options(limen_unit_tests PRIVATE ${LIMEN_TEST_OPTIONS})
limen_unity(limen_unit_tests ${LIMEN_UNIT_TESTS})
target_include_directories(limen_unit_tests PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_precompile_headers(limen_unit_tests PRIVATE ${LIMEN_TEST_HEADERS}
  <limen/base/error.h> <limen/base/progress.h> <limen/model/bim_model.h> <limen/model/result.h>)
target_link_libraries(limen_unit_tests PRIVATE limen limen_simulate limen_cli limen_options fmt::fmt
  nlohmann_json::nlohmann_json rapidcheck GTest::gtest_main)
if(LIMEN_BUILD_IFC)
  target_compile_definitions(limen_unit_tests PRIVATE LIMEN_WITH_IFC=1)
  add_dependencies(limen_unit_tests limen_ifc)
endif()
gtest_discover_tests(limen_unit_tests PROPERTIES LABELS unit DISCOVERY_MODE PRE_TEST)

file(GLOB LIMEN_ACCEPTANCE_TESTS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/*_test.cpp)
if(LIMEN_ACCEPTANCE_TESTS)
  add_executable(limen_acceptance_tests ${LIMEN_ACCEPTANCE_TESTS} tests/fuzz/readers.cpp)
  limen_unity(limen_acceptance_tests ${LIMEN_ACCEPTANCE_TESTS})
  # The server's own header names JSON as the library does, the other tests as nlohmann does.
  set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/serve_test.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(limen_acceptance_tests PRIVATE limen limen_simulate limen_cli limen_options fmt::fmt
    nlohmann_json::nlohmann_json GTest::gtest_main)
  target_include_directories(limen_acceptance_tests PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_precompile_headers(limen_acceptance_tests PRIVATE ${LIMEN_TEST_HEADERS})
  target_compile_definitions(limen_acceptance_tests PRIVATE LIMEN_PROGRAM="$<TARGET_FILE:limen_program>"
    LIMEN_CORPUS="${PROJECT_SOURCE_DIR}/tests/corpus")
  # g++ 12 warns of "literal" + string where nothing overlaps (its bug 105651).
  target_compile_options(limen_acceptance_tests PRIVATE ${LIMEN_TEST_OPTIONS} $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  add_dependencies(limen_acceptance_tests limen_program)
  gtest_discover_tests(limen_acceptance_tests PROPERTIES LABELS acceptance DISCOVERY_MODE PRE_TEST)
endif()

add_test(NAME floors COMMAND ${PROJECT_SOURCE_DIR}/scripts/check_floors)
add_test(NAME floors_are_checked COMMAND ${PROJECT_SOURCE_DIR}/tests/tools/check_floors_test)
add_test(NAME names COMMAND ${PROJECT_SOURCE_DIR}/scripts/check_names)
add_test(NAME names_are_checked COMMAND ${PROJECT_SOURCE_DIR}/tests/tools/check_names_test)
set_tests_properties(floors floors_are_checked names names_are_checked PROPERTIES LABELS unit)

add_test(NAME links_of_the_documentation COMMAND ${PROJECT_SOURCE_DIR}/tests/tools/links_test)
set_tests_properties(links_of_the_documentation PROPERTIES LABELS unit)

add_test(NAME calibration_counts COMMAND ${PROJECT_SOURCE_DIR}/tests/tools/calibration_test)
set_tests_properties(calibration_counts PROPERTIES LABELS unit)

# What the first page of the documentation says is run.
add_test(NAME commands_of_the_first_hour COMMAND ${PROJECT_SOURCE_DIR}/tests/tools/docs_test $<TARGET_FILE:limen_program>)
set_tests_properties(commands_of_the_first_hour PROPERTIES LABELS acceptance)

add_test(NAME installed_package
         COMMAND ${CMAKE_COMMAND} -DBUILD_DIR=${PROJECT_BINARY_DIR}
                 -DCONSUMER_DIR=${PROJECT_SOURCE_DIR}/tests/consumer
                 -DWORK_DIR=${PROJECT_BINARY_DIR}/installed_package -DGENERATOR=${CMAKE_GENERATOR}
                 -DCOMPILER=${CMAKE_CXX_COMPILER} "-DFLAGS=${CMAKE_CXX_FLAGS}"
                 -P ${PROJECT_SOURCE_DIR}/cmake/test_install.cmake)
set_tests_properties(installed_package PROPERTIES LABELS acceptance)

if(NOT LIMEN_BUILD_BENCHMARKS AND NOT CMAKE_CXX_FLAGS MATCHES "sanitize")
  include(cmake/read_benchmarks.cmake)
endif()

# The sanitizers' own libraries are not for handing on.
if(LIMEN_BUILD_IFC AND NOT "${CMAKE_CXX_FLAGS} ${CMAKE_EXE_LINKER_FLAGS}" MATCHES "sanitize")
  add_test(NAME bundle_runs_anywhere COMMAND ${PROJECT_SOURCE_DIR}/tests/tools/bundle_test ${PROJECT_BINARY_DIR})
  set_tests_properties(bundle_runs_anywhere PROPERTIES LABELS acceptance SKIP_RETURN_CODE 77)
endif()

if(LIMEN_BUILD_PYTHON)
  include(cmake/python_tests.cmake)
endif()

# Needs node, playwright-core and a Chromium; says so and is skipped where one is missing.
add_test(NAME report_in_browser
         COMMAND ${PROJECT_SOURCE_DIR}/tests/browser/run $<TARGET_FILE:limen_program>)
# The longest of all: it begins first, with others beside it.
set_tests_properties(report_in_browser PROPERTIES LABELS acceptance COST 200 SKIP_RETURN_CODE 77 TIMEOUT 600)
