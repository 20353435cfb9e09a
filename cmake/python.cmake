# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# The compiled part of the Python package, beside its Python files in <build>/python/limen: a folder that
# can stand on PYTHONPATH. python/limen_build.py makes a wheel of it.
# LIMEN_PYTHON_HEADERS and LIMEN_PYTHON_SOABI stand for a Python that is not installed here (scripts/wheel).
# The first python3 that has NumPy: another one may come first on the PATH.
if(NOT Python3_EXECUTABLE AND NOT LIMEN_PYTHON_HEADERS)
  find_program(LIMEN_PATH_PYTHON python3)
  foreach(candidate IN ITEMS ${LIMEN_PATH_PYTHON} /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "import numpy" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
    if(status EQUAL 0)
      set(Python3_EXECUTABLE ${candidate} CACHE FILEPATH "The Python that the package is built for")
      break()
    endif()
  endforeach()
endif()
find_path(PYBIND11_INCLUDE_DIR pybind11/pybind11.h REQUIRED)
set(LIMEN_PYTHON_DIR ${PROJECT_BINARY_DIR}/python/limen)
file(GLOB LIMEN_PYTHON_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/src/*.cpp)
if(NOT LIMEN_BUILD_SIMULATOR)
  list(FILTER LIMEN_PYTHON_SOURCES EXCLUDE REGEX "/simulation\\.cpp$")
endif()

if(LIMEN_PYTHON_HEADERS)
  set(Python3_INCLUDE_DIRS ${LIMEN_PYTHON_HEADERS})
  add_library(limen_python MODULE ${LIMEN_PYTHON_SOURCES})
  set_target_properties(limen_python PROPERTIES PREFIX "" SUFFIX .${LIMEN_PYTHON_SOABI}.so)
else()
  find_package(Python3 COMPONENTS Interpreter Development.Module REQUIRED)
  Python3_add_library(limen_python MODULE WITH_SOABI ${LIMEN_PYTHON_SOURCES})
endif()
limen_unity(limen_python ${LIMEN_PYTHON_SOURCES})
set_target_properties(limen_python PROPERTIES OUTPUT_NAME _limen CXX_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${LIMEN_PYTHON_DIR})
target_include_directories(limen_python SYSTEM PRIVATE ${PYBIND11_INCLUDE_DIR} ${Python3_INCLUDE_DIRS})
target_link_libraries(limen_python PRIVATE limen limen_options fmt::fmt)
# It only hands on: at -O2 the compiler takes two fifths longer for it. pybind11 moves matrices before they are filled.
target_compile_options(limen_python PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-O1;-Wno-maybe-uninitialized>")
if(LIMEN_BUILD_SIMULATOR)
  set_target_properties(limen_simulate PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(limen_python PRIVATE limen_simulate)
  target_compile_definitions(limen_python PRIVATE LIMEN_WITH_SIMULATOR=1)
endif()

file(GLOB LIMEN_PYTHON_FILES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/limen/*)
add_custom_target(limen_python_package ALL
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${LIMEN_PYTHON_FILES} ${LIMEN_PYTHON_DIR}
  COMMAND ${CMAKE_COMMAND} -E copy_if_different $<TARGET_FILE:limen_program> ${LIMEN_PYTHON_DIR}/limen_program
  DEPENDS limen_python COMMENT "Gathering the Python package")
add_dependencies(limen_python_package limen_program)
if(LIMEN_BUILD_IFC)
  # Looked for beside the module first.
  add_dependencies(limen_python_package limen_ifc)
  add_custom_command(TARGET limen_python_package POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E copy_if_different $<TARGET_FILE:limen_ifc> ${LIMEN_PYTHON_DIR})
endif()
