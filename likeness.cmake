# The one way a room declares its library, and a test its program:
#
#   likeness_library(measured SOURCES merl.cc read.cc [COMMANDS command.cc] NEEDS likeness::brdf likeness::files
#                    [WITH Ceres::ceres] [FOLDERS of further headers])
#   likeness_test(measured_test [COMPUTES 1] SOURCES merl_test.cc NEEDS likeness::measured [WITH TBB::tbb] [TIMEOUT 120])
#
# NEEDS names rooms, which is the order of the house (tests/house/layout_test reads it from these lines); WITH names
# packages. A room without SOURCES is header only, and its packages reach whoever uses it; otherwise they stay
# private to the room's sources. The target is likeness::NAME; headers are included from the root of the repository.

set(LIKENESS_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(LIKENESS_DEVELOPER)
  list(APPEND LIKENESS_WARNINGS -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND LIKENESS_WARNINGS -Wno-restrict)  # false at "text" + std::string (GCC bug 105651)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  list(APPEND LIKENESS_WARNINGS -Wno-maybe-uninitialized)  # false in instrumented code, as the manual of GCC says
endif()
# Static libraries are compiled so that a module can hold them; nobody replaces their functions, so calls within a source
# file may be inlined as they are in a program.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-fno-semantic-interposition)
  # Collecting garbage is a twentieth of what compiling takes, for memory that machines have.
  add_compile_options(--param=ggc-min-heapsize=524288)
endif()
add_library(likeness_warnings INTERFACE)
add_library(likeness::warnings ALIAS likeness_warnings)
target_compile_options(likeness_warnings INTERFACE ${LIKENESS_WARNINGS})

# Speed-ups that are used where they are found; -DCMAKE_CXX_COMPILER_LAUNCHER= (empty) builds without ccache. The preset
# release has none: its precompiled headers and joined sources leave a cache little to find.
if(PROJECT_IS_TOP_LEVEL)
  find_program(LIKENESS_CCACHE ccache)
  if(LIKENESS_CCACHE AND NOT LIKENESS_PARSE_ONCE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${LIKENESS_CCACHE})
  endif()
  find_program(LIKENESS_MOLD mold)
  if(LIKENESS_MOLD)
    add_link_options(-fuse-ld=mold)
  endif()
endif()

# The headers that most sources read are a third of what compiling takes: the preset release parses them once for each
# kind of source (LIKENESS_PARSE_ONCE). They are no promise: a source includes what it uses, as the other presets see to.
set(LIKENESS_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <cstdio> <filesystem> <fstream> <functional> <iostream>
    <limits> <map> <memory> <numbers> <numeric> <optional> <random> <set> <span> <sstream> <stdexcept> <string>
    <string_view> <tuple> <utility> <variant> <vector> <glm/geometric.hpp> <glm/mat3x3.hpp> <glm/mat4x4.hpp>
    <glm/vec2.hpp> <glm/vec3.hpp>)
# Kinds, and how they are optimised: a room as the build type says (-O3), what runs once a process, tests.
set(LIKENESS_LEVEL_OF_room)
set(LIKENESS_LEVEL_OF_once -O1)
set(LIKENESS_LEVEL_OF_test -O0)
set(LIKENESS_LEVEL_OF_test_that_computes -O1)
function(likeness_parse_once target kind)
  if(NOT LIKENESS_PARSE_ONCE)
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False in libstdc++'s strings, which are no longer known for a system's header (GCC bugs 105329 and 105651).
    target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
  endif()
  set(owner likeness_headers_${kind})
  if(NOT TARGET ${owner})
    set(source ${CMAKE_BINARY_DIR}/${owner}.cc)
    file(CONFIGURE OUTPUT ${source} CONTENT "")
    add_library(${owner} OBJECT ${source})
    target_compile_features(${owner} PRIVATE cxx_std_20)
    target_compile_options(${owner} PRIVATE ${LIKENESS_LEVEL_OF_${kind}} ${LIKENESS_WARNINGS})
    target_precompile_headers(${owner} PRIVATE ${LIKENESS_COMMON_HEADERS})
    if(kind MATCHES "^test")
      target_link_libraries(${owner} PRIVATE GTest::gtest)
      target_precompile_headers(${owner} PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
      set_target_properties(${owner} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    else()
      target_precompile_headers(${owner} PRIVATE <nlohmann/json.hpp>)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# The preset release compiles a room's sources together, eight at a time: a third of the time. What is named in the
# anonymous namespaces of a room is therefore named once; APART says that a room's sources cannot be joined. COLD says
# that the time of a whole room hardly counts.
function(likeness_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "APART;COLD" "" "SOURCES;COMMANDS;NEEDS;WITH;FOLDERS")
  set(target likeness_${name})
  if(arg_COMMANDS)
    list(TRANSFORM arg_COMMANDS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    set_property(GLOBAL APPEND PROPERTY LIKENESS_COMMANDS ${arg_COMMANDS})
    set_property(GLOBAL APPEND PROPERTY LIKENESS_COMMANDS_NEED likeness::${name} ${arg_NEEDS} ${arg_WITH})
  endif()
  if(arg_SOURCES)
    # Pages and tables run once a process: a third of the time to compile them is worth more.
    set(words "(page|report|tables|verdict)\\.cc$")
    if(arg_COLD)
      set(words "\\.cc$")
    endif()
    set(once ${arg_SOURCES})
    list(FILTER once INCLUDE REGEX ${words})
    list(FILTER arg_SOURCES EXCLUDE REGEX ${words})
    if(once)
      add_library(${target}_once OBJECT ${once})
      target_compile_options(${target}_once PRIVATE $<$<CONFIG:Release>:${LIKENESS_LEVEL_OF_once}>)
      target_compile_definitions(${target}_once PRIVATE $<TARGET_PROPERTY:${target},COMPILE_DEFINITIONS>)
      target_include_directories(${target}_once PRIVATE ${PROJECT_SOURCE_DIR})
      likeness_parse_once(${target}_once once)
      list(APPEND arg_SOURCES $<TARGET_OBJECTS:${target}_once>)
    endif()
    add_library(${target} STATIC ${arg_SOURCES})
    likeness_parse_once(${target} room)
    foreach(part ${target} ${target}_once)
      if(TARGET ${part})
        target_compile_options(${part} PRIVATE ${LIKENESS_WARNINGS})
        target_compile_features(${part} PRIVATE cxx_std_20)
        target_link_libraries(${part} PUBLIC ${arg_NEEDS} PRIVATE ${arg_WITH})
        if(arg_APART)
          set_target_properties(${part} PROPERTIES UNITY_BUILD OFF)
        endif()
      endif()
    endforeach()
    set(reach PUBLIC)
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_NEEDS} ${arg_WITH})
    set(reach INTERFACE)
  endif()
  add_library(likeness::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} UNITY_BUILD_BATCH_SIZE 8)
  target_compile_features(${target} ${reach} cxx_std_20)
  target_include_directories(${target} ${reach} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/likeness>)

  # Each room is a component of the package, with an export of its own, so that one can be installed alone.
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  install(TARGETS ${target} EXPORT likeness-${name}-targets ARCHIVE COMPONENT ${name})
  install(EXPORT likeness-${name}-targets NAMESPACE likeness:: COMPONENT ${name}
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/likeness)
  foreach(inner . ${arg_FOLDERS})
    file(GLOB headers CONFIGURE_DEPENDS ${inner}/*.h)
    list(FILTER headers EXCLUDE REGEX "command\\.h$")
    cmake_path(SET at NORMALIZE ${CMAKE_INSTALL_INCLUDEDIR}/likeness/${folder}/${inner})
    install(FILES ${headers} COMPONENT ${name} DESTINATION ${at})
  endforeach()

  # What likeness-config.cmake looks for: the rooms below, and the package of each imported target.
  list(TRANSFORM arg_NEEDS REPLACE "^likeness::" "")
  list(TRANSFORM arg_WITH REPLACE "::.*$" "")
  string(CONCAT rooms "set(likeness_${name}_needs ${arg_NEEDS})\n" "set(likeness_${name}_packages ${arg_WITH})\n")
  string(REPLACE ";" " " rooms "${rooms}")
  set_property(GLOBAL APPEND_STRING PROPERTY LIKENESS_ROOMS "${rooms}")
endfunction()

# The files in which rooms read the words of a command line, as one library of the program (and of tests that call
# them). CLI11 takes five seconds of each source that includes it, so the preset release reads it twice for all; and
# who uses the rooms as libraries needs no CLI11.
function(likeness_commands)
  get_property(sources GLOBAL PROPERTY LIKENESS_COMMANDS)
  get_property(needs GLOBAL PROPERTY LIKENESS_COMMANDS_NEED)
  list(REMOVE_DUPLICATES needs)
  add_library(likeness_commands STATIC ${sources})
  add_library(likeness::commands ALIAS likeness_commands)
  target_compile_features(likeness_commands PRIVATE cxx_std_20)
  target_compile_options(likeness_commands PRIVATE $<$<CONFIG:Release>:-O1> ${LIKENESS_WARNINGS})
  target_compile_definitions(likeness_commands PRIVATE LIKENESS_VERSION="${PROJECT_VERSION}")
  target_include_directories(likeness_commands PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(likeness_commands PRIVATE CLI11::CLI11 ${needs})
endfunction()

# A part of a room that is loaded when it is first used (render/files/module.h), for libraries that cost every process time.
function(likeness_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "ROOM" "SOURCES;WITH")
  add_library(likeness_${name} MODULE ${arg_SOURCES})
  target_include_directories(likeness_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(likeness_${name} PRIVATE ${arg_WITH} likeness::warnings)
  set_target_properties(likeness_${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden
                        LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/likeness)
  add_dependencies(likeness_${arg_ROOM} likeness_${name})
  install(TARGETS likeness_${name} LIBRARY DESTINATION lib/likeness COMPONENT ${arg_ROOM})
endfunction()

# Installs the package file that find_package(likeness CONFIG [COMPONENTS brdf fit ...]) reads. It travels with brdf,
# which every other room stands on.
function(likeness_package)
  include(CMakePackageConfigHelpers)
  get_property(LIKENESS_ROOMS GLOBAL PROPERTY LIKENESS_ROOMS)
  set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/likeness)
  configure_package_config_file(likeness-config.cmake.in likeness-config.cmake INSTALL_DESTINATION ${folder}
                                NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
  write_basic_package_version_file(likeness-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/likeness-config.cmake ${PROJECT_BINARY_DIR}/likeness-config-version.cmake
          COMPONENT brdf DESTINATION ${folder})
endfunction()

# One program, one entry of CTest: a process that loads OpenImageIO costs 0.3 s before its first line. The data that
# developers share lies beside the checkout; a test that finds none says so and skips.
#
# Headers are half of the time that tests take to compile, so ./bootstrap compiles the sources of a program together
# (CMAKE_UNITY_BUILD of the preset release). APART says that they use the same names for different things, and are not.
# What is tested is in the rooms, which are optimised; to optimise tests too takes longer than they run. COMPUTES 1
# says that this one computes so much itself, or evaluates headers so often, that -O1 pays, COMPUTES 2 that -O2 does.
function(likeness_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "APART" "TIMEOUT;COMPUTES" "SOURCES;NEEDS;WITH")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  add_executable(${name} ${arg_SOURCES})
  if(arg_COMPUTES EQUAL 2)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O2>)
  else()
    set(kind test)
    if(arg_COMPUTES)
      set(kind test_that_computes)
    endif()
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:${LIKENESS_LEVEL_OF_${kind}}>)
    likeness_parse_once(${name} ${kind})
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  endif()
  if(arg_APART)
    set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  endif()
  target_compile_definitions(${name} PRIVATE LIKENESS_SHARED_DIR="${LIKENESS_SHARED_DIR}"
                                             LIKENESS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE likeness::warnings ${arg_NEEDS} ${arg_WITH} GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${arg_TIMEOUT})
endfunction()
