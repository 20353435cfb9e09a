# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# Makes a C++ source of the report page's own sources, at build time:
#   cmake -DPAGE_DIR=src/limen/report/html/page -DOUTPUT=report_page.cpp -P embed.cmake
# A literal may not be arbitrarily long: every file becomes one, joined by the compiler.
set(SCRIPTS math.js data.js shaders.js gl.js scene.js camera.js pick.js panel.js main.js)

function(as_literals out)
  set(text "")
  foreach(name ${ARGN})
    file(READ ${PAGE_DIR}/${name} content)
    string(APPEND text "R\"limen_page(${content})limen_page\"\n")
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

as_literals(pattern page.html)
as_literals(style page.css)
as_literals(script ${SCRIPTS})
set(text "// Made by cmake/embed.cmake from src/limen/report/html/page: change it there.\n#include \"limen/report/html/report_page.h\"\n")
string(APPEND text "\nnamespace limen {\n\nstd::string_view report_pattern() {\n  return\n${pattern};\n}\n")
string(APPEND text "\nstd::string_view report_style() {\n  return\n${style};\n}\n")
string(APPEND text "\nstd::string_view report_script() {\n  return\n${script};\n}\n\n}  // namespace limen\n")
file(WRITE ${OUTPUT} "${text}")
