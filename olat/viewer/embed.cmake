# Writes the page's files into one C++ source:  cmake -D OUT=FILE -D VIEWER=FOLDER "-DSCRIPTS=a.js;b.js" -P embed.cmake
# Scripts are modules while they are written and one module when they are sent: `import` lines go, `export` words go, and
# no name may stand at the top of two of them.
set(work ${OUT}.parts)
file(MAKE_DIRECTORY ${work})
file(WRITE ${work}/viewer.js "")
foreach(file IN LISTS SCRIPTS)
  file(READ ${file} text)
  string(REGEX REPLACE "(^|\n)import [^\n]*" "\\1" text "${text}")
  string(REGEX REPLACE "(^|\n)export {[^\n]*" "\\1" text "${text}")
  string(REGEX REPLACE "(^|\n)export " "\\1" text "${text}")
  file(APPEND ${work}/viewer.js "${text}")
endforeach()

# A text as bytes, since compilers limit the length of a literal.
set(source "// Made by olat/viewer/embed.cmake.\n#include <string_view>\n\nnamespace likeness::olat_view {\n")
foreach(entry "index_html;${VIEWER}/index.html" "viewer_css;${VIEWER}/viewer.css" "viewer_js;${work}/viewer.js"
              "view_glsl;${VIEWER}/view.glsl" "icon_svg;${VIEWER}/icon.svg" "report_html;${VIEWER}/report.html")
  list(GET entry 0 name)
  list(GET entry 1 file)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND source "extern const std::string_view k_${name};\nstatic constexpr char ${name}_bytes[] = {${bytes}'\\0'};\n"
                       "const std::string_view k_${name}{${name}_bytes, sizeof ${name}_bytes - 1};\n")
endforeach()
string(APPEND source "}  // namespace likeness::olat_view\n")
file(WRITE ${OUT} "${source}")
