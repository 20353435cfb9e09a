# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# At install time: copies limen/limen.h and every header it reaches. Called with LIMEN_HEADER_ROOT (the folder
# that holds limen/) and LIMEN_HEADER_DESTINATION (relative to the prefix).
cmake_policy(VERSION 3.25)
set(waiting limen/limen.h)
set(reached "")
while(waiting)
  list(POP_FRONT waiting header)
  list(APPEND reached ${header})
  if(header MATCHES "/(judge|prepare)/")
    message(FATAL_ERROR "limen/limen.h reaches ${header}, which is no user's")
  endif()
  file(STRINGS ${LIMEN_HEADER_ROOT}/${header} lines REGEX "^#include \"limen/[^\"]+\"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" used "${line}")
    # What is made at build time is installed by its own rule.
    if(NOT used IN_LIST reached AND NOT used IN_LIST waiting AND EXISTS ${LIMEN_HEADER_ROOT}/${used})
      list(APPEND waiting ${used})
    endif()
  endforeach()
endwhile()
foreach(header IN LISTS reached)
  get_filename_component(folder ${header} DIRECTORY)
  file(INSTALL DESTINATION "${CMAKE_INSTALL_PREFIX}/${LIMEN_HEADER_DESTINATION}/${folder}" TYPE FILE
       FILES "${LIMEN_HEADER_ROOT}/${header}")
endforeach()
