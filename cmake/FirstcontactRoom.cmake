# A room of the library is a folder of src/firstcontact and one static target.
#
#   firstcontact_add_room(<name> SOURCES <files> [HEADERS <files>] [ROOMS <rooms>] [LIBRARIES <targets>])
#
# HEADERS are compiled alone in `ci`. ROOMS are those that it includes directly; tools/check_includes holds what
# each room may include. LIBRARIES are packages that only its sources need.
function(firstcontact_add_room name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;HEADERS;ROOMS;LIBRARIES")
  list(TRANSFORM arg_ROOMS PREPEND firstcontact::)
  set(target firstcontact_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(firstcontact::${name} ALIAS ${target})
  if(arg_HEADERS)
    target_sources(${target} PUBLIC
      FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${arg_HEADERS})
  endif()
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  target_link_libraries(${target}
    PUBLIC Eigen3::Eigen ${arg_ROOMS}
    PRIVATE ${arg_LIBRARIES} $<BUILD_INTERFACE:firstcontact_build_flags>)
endfunction()
