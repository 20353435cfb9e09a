# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# Several sources, compiled as one: most of the time goes into templates (Eigen, fmt, the containers) that every file
# alone would instantiate again. Sources of one floor (or of the folder, outside src/limen) lie together, in the order
# of their names, so many that the compiler stays below 1.4 GB. A new file moves only its own floor's groups.
#   cmake -DLIMEN_UNITY_BUILD=OFF   each file alone: what an editor, clang-tidy and work on one file want
option(LIMEN_UNITY_BUILD "Compile the sources in groups: a third of the time for all, more for one" ON)

# Bytes of source in a group; fewer where most lines are matrices, or make JSON.
set(LIMEN_UNITY_BYTES 140000)
set(LIMEN_UNITY_BYTES_DENSE 100000)
set(LIMEN_UNITY_BYTES_DENSEST 68000)
set(LIMEN_UNITY_DENSE "cli;geometry;match;register;sight;python_src")
set(LIMEN_UNITY_DENSEST "deviation;project;report")

# limen_unity(TARGET SOURCES...)
function(limen_unity target)
  if(NOT LIMEN_UNITY_BUILD)
    return()
  endif()
  set(floor "")
  set(number 0)
  set(bytes 0)
  set(sources ${ARGN})
  list(SORT sources)
  foreach(source IN LISTS sources)
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${source})
    string(REGEX REPLACE "^src/limen/([^/]*)/.*" "\\1" mine ${path})
    if(mine STREQUAL path)
      get_filename_component(mine ${path} DIRECTORY)
      string(REPLACE "/" "_" mine ${mine})
    endif()
    file(SIZE ${source} size)
    set(most ${LIMEN_UNITY_BYTES})
    if(mine IN_LIST LIMEN_UNITY_DENSE)
      set(most ${LIMEN_UNITY_BYTES_DENSE})
    elseif(mine IN_LIST LIMEN_UNITY_DENSEST)
      set(most ${LIMEN_UNITY_BYTES_DENSEST})
    endif()
    math(EXPR bytes "${bytes} + ${size}")
    if(NOT mine STREQUAL floor)
      set(floor ${mine})
      set(number 0)
      set(bytes ${size})
    elseif(bytes GREATER most)
      math(EXPR number "${number} + 1")
      set(bytes ${size})
    endif()
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${floor}_${number})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # A type of an unnamed namespace may stand in a class of the same file: it is that file's alone, here as there.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
