# The one way a room declares its library:
#
#   likeness_library(measured SOURCES merl.cc read.cc NEEDS likeness::brdf likeness::files [WITH Ceres::ceres])
#
# NEEDS names rooms, which is the order of the house (tests/layout_test reads it); WITH names packages that
# stay private to the room's sources. The target is likeness::NAME; headers are included from the root.

add_library(likeness_warnings INTERFACE)
add_library(likeness::warnings ALIAS likeness_warnings)
if(LIKENESS_DEVELOPER)
  target_compile_options(likeness_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
endif()

function(likeness_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;NEEDS;WITH")
  add_library(likeness_${name} STATIC ${arg_SOURCES})
  add_library(likeness::${name} ALIAS likeness_${name})
  target_include_directories(likeness_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(likeness_${name} PUBLIC ${arg_NEEDS} PRIVATE ${arg_WITH} $<BUILD_INTERFACE:likeness_warnings>)
endfunction()
