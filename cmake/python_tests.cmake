# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# One test per file of python/tests, on the package as it lies in the build folder.
file(GLOB LIMEN_PYTHON_TESTS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/tests/test_*.py)
foreach(script IN LISTS LIMEN_PYTHON_TESTS)
  get_filename_component(name ${script} NAME_WE)
  string(REPLACE "test_" "python_" name ${name})
  add_test(NAME ${name} COMMAND ${Python3_EXECUTABLE} -B ${script})
  set_tests_properties(${name} PROPERTIES LABELS acceptance COST 50 TIMEOUT 600 ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/python;LIMEN_PYTHON_BUILD_DIR=${PROJECT_BINARY_DIR}")
endforeach()
