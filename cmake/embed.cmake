# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# Makes a C++ source of a page's own sources, at build time:
#   cmake -DPAGE_DIR=src/limen/report/html/page -DPAGES=report -DOUTPUT=report_page.cpp -P embed.cmake
#   cmake -DPAGE_DIR=src/limen/cli/serve/page -DPAGES=serve -DOUTPUT=serve_page.cpp -P embed.cmake
# A literal may not be arbitrarily long: every file becomes one, joined by the compiler.
set(SHARED_SCRIPTS math.js data.js shaders.js gl.js scene.js camera.js pick.js panel.js keys.js)

function(as_literals out)
  set(text "")
  foreach(name ${ARGN})
    file(READ ${PAGE_DIR}/${name} content)
    string(APPEND text "R\"limen_page(${content})limen_page\"\n")
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

if(PAGES STREQUAL "serve")
  set(header limen/cli/serve/serve_page.h)
else()
  set(header limen/report/html/report_page.h)
endif()
set(text "// Made by cmake/embed.cmake from the folder page beside the header: change it there.\n#include \"${header}\"\n")
string(APPEND text "\nnamespace limen {\n")
# A function per part: its name, then the files it is made of.
function(add_part name)
  as_literals(content ${ARGN})
  string(APPEND text "\nstd::string_view ${name}() {\n  return\n${content};\n}\n")
  set(text "${text}" PARENT_SCOPE)
endfunction()
if(PAGES STREQUAL "serve")
  add_part(serve_page_html serve.html)
  add_part(serve_page_css serve.css)
  add_part(serve_page_js serve.js)
else()
  add_part(page_head head.html)
  add_part(report_pattern head.html page.html)
  add_part(report_style page.css)
  add_part(report_script ${SHARED_SCRIPTS} main.js)
  add_part(view_pattern head.html view.html viewer.html view_end.html)
  add_part(view_style view.css)
  add_part(view_script ${SHARED_SCRIPTS} pairs.js view.js)
  add_part(project_pattern head.html project.html viewer.html project_end.html)
  add_part(project_style project.css)
  add_part(project_script ${SHARED_SCRIPTS} pairs.js view.js answers.js)
endif()
string(APPEND text "\n}  // namespace limen\n")
file(WRITE ${OUTPUT} "${text}")
