set(prefix ${SCRATCH_DIR}/prefix)
set(build ${SCRATCH_DIR}/build)
set(snippets ${SCRATCH_DIR}/snippets)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${SCRATCH_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
set(options "")
if(EXISTS ${prefix}/include/firstcontact_ompl)
  set(options --ompl)
endif()
file(MAKE_DIRECTORY ${snippets})
run(${PYTHON} ${CONSUMER_DIR}/../page_snippets.py ${SOURCE_DIR} ${snippets} ${options})
# Nothing is optimised: much is compiled, and little is run.
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${build} -G ${GENERATOR} -D SNIPPETS_DIR=${snippets}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_FLAGS=-O0
  -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(${CMAKE_COMMAND} --build ${build})
run(${build}/consumer)

# The installed tool finds its library.
if(WITH_TOOL)
  run(${prefix}/bin/firstcontact --version)
endif()
