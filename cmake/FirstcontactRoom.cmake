# A room of the library is a folder of src/firstcontact and one static target.
#
#   firstcontact_add_room(<name> SOURCES <files> [HEADERS <files>] [ROOMS <rooms>] [LIBRARIES <targets>]
#                         [APART <files>] [KERNELS] [FUZZED])
#
# HEADERS are compiled alone by `./dev lint`, those that are installed in `ci` too. ROOMS are those that it includes
# directly; tools/check_includes holds what each room may include. LIBRARIES are packages that only its sources need.
# With FIRSTCONTACT_UNITY_BUILD several files are compiled as one, but each of APART alone: it has names that another
# file has, too. Rooms of KERNELS are compiled file by file in all builds, so that their machine code is the same.
# FUZZED rooms read files or messages: fuzz targets are led by their branches. To count branches elsewhere would only
# slow the tests.
function(firstcontact_add_room name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "KERNELS;FUZZED" "" "SOURCES;HEADERS;ROOMS;LIBRARIES;APART")
  list(TRANSFORM arg_ROOMS PREPEND firstcontact::)
  set(target firstcontact_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(firstcontact::${name} ALIAS ${target})
  if(NOT arg_KERNELS)
    set_target_properties(${target} PROPERTIES
      UNITY_BUILD ${FIRSTCONTACT_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 8)
  endif()
  if(arg_FUZZED AND FIRSTCONTACT_BUILD_FUZZERS)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  set_source_files_properties(${arg_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(arg_HEADERS)
    target_sources(${target} PUBLIC
      FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${arg_HEADERS})
  endif()
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  target_link_libraries(${target}
    PUBLIC Eigen3::Eigen ${arg_ROOMS}
    PRIVATE ${arg_LIBRARIES} $<BUILD_INTERFACE:firstcontact_build_flags>)
endfunction()
