# Precompiled headers, and tests that are compiled together: they halve the time of a build from nothing.
#
# Off by default: a file that forgets an include must not compile because of them. The builds of `release`,
# `lint` and of users see each file as it stands, and every installed header is compiled alone in `ci`.

option(FIRSTCONTACT_QUICK_BUILD "Precompile headers, and compile tests several at a time" OFF)
option(FIRSTCONTACT_UNITY_BUILD "Compile the library several files at a time: quick from nothing, slow after a change" OFF)
if(FIRSTCONTACT_QUICK_BUILD AND CMAKE_CXX_COMPILER_LAUNCHER MATCHES ccache)
  # What ccache asks for (nothing here reads __TIME__); and paths that build folders have in common, by which the
  # Python package takes what `ci` has compiled.
  list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER
    env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_DEPEND=1)
endif()

# What most files of the library read.
set(firstcontact_common_headers
  <algorithm> <array> <cmath> <cstddef> <cstdint> <filesystem> <functional> <limits> <map> <memory>
  <numbers> <optional> <span> <stdexcept> <string> <string_view> <utility> <variant> <vector>
  <Eigen/Geometry>)

# Precompiles headers for a target: firstcontact_precompile(<target> <header>...),
# or takes those of a target with the same flags: firstcontact_precompile(<target> FROM <other>).
function(firstcontact_precompile target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FROM" "")
  if(NOT FIRSTCONTACT_QUICK_BUILD)
    return()
  endif()
  if(arg_FROM)
    get_target_property(options ${target} COMPILE_OPTIONS)
    get_target_property(options_from ${arg_FROM} COMPILE_OPTIONS)
    list(FILTER options INCLUDE REGEX fuzzer)
    list(FILTER options_from INCLUDE REGEX fuzzer)
    if(NOT "${options}" STREQUAL "${options_from}")
      message(FATAL_ERROR "${target} takes the precompiled headers of ${arg_FROM}, so both must be FUZZED or neither.")
    endif()
    target_precompile_headers(${target} REUSE_FROM ${arg_FROM})
  else()
    target_precompile_headers(${target} PRIVATE ${firstcontact_common_headers} ${arg_UNPARSED_ARGUMENTS})
  endif()
  # Times of files would make each precompiled header another one to ccache.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)
endfunction()

# Options of what spends its time in the library: clang makes checks of memory in half the time with -O0.
set(firstcontact_caller_options "")
if(FIRSTCONTACT_QUICK_BUILD AND FIRSTCONTACT_SANITIZERS)
  set(firstcontact_caller_options -O0)
endif()
