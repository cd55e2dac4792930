# Builds the core alone, without the packages that readers of files need, and uses it from its installation.
set(build ${SCRATCH_DIR})
set(prefix ${SCRATCH_DIR}/prefix)
set(consumer ${SCRATCH_DIR}/consumer)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(package tinyxml2 yaml-cpp nlohmann_json CLI11 fmt GTest)
  list(APPEND without -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
file(REMOVE_RECURSE ${build})
# With the flags of the build that runs this test, so that a compiler cache has its objects.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${build} -G ${GENERATOR} ${without}
  -D FIRSTCONTACT_CORE_ONLY=ON -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=${BUILD_TYPE}
  -D CMAKE_CXX_FLAGS_RELEASE=${RELEASE_FLAGS} -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
  -D FIRSTCONTACT_QUICK_BUILD=${QUICK} -D FIRSTCONTACT_UNITY_BUILD=${UNITY}
  -D FIRSTCONTACT_WARNINGS_AS_ERRORS=${WARNINGS_AS_ERRORS})
run(${CMAKE_COMMAND} --build ${build} --target firstcontact)
run(${CMAKE_COMMAND} --install ${build} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${consumer} -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${consumer})
run(${consumer}/consumer)

file(GET_RUNTIME_DEPENDENCIES LIBRARIES ${build}/src/firstcontact/libfirstcontact.so
  RESOLVED_DEPENDENCIES_VAR libraries UNRESOLVED_DEPENDENCIES_VAR missing)
foreach(library IN LISTS libraries missing)
  cmake_path(GET library FILENAME name)
  if(NOT name MATCHES "^(ld-linux.*|lib(tbb|hwy|stdc\\+\\+|m|gcc_s|c|pthread|atomic)\\.so.*)$")
    message(FATAL_ERROR "The core must need Eigen, TBB and Highway alone, but links ${name}")
  endif()
endforeach()
