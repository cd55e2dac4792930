# Warnings, sanitizers and the rules for a module, in one place. Nothing here reaches a consumer.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()
# The installed tool finds the library beside it, wherever the prefix is moved.
set(CMAKE_INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR})

option(FIRSTCONTACT_WARNINGS_AS_ERRORS "Treat warnings as errors" OFF)
set(FIRSTCONTACT_SANITIZERS "" CACHE STRING "Value of -fsanitize=, empty for none")

add_library(firstcontact_build_flags INTERFACE)
target_compile_options(firstcontact_build_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  # The error bounds are derived for the operations as written.
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13
    AND CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT FIRSTCONTACT_WARNINGS_AS_ERRORS)
  # At -O3 GCC 12 warns of every "literal" + std::string (GCC bug 105651; by any of three warnings), and of
  # statics with empty vectors.
  target_compile_options(firstcontact_build_flags INTERFACE
    -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-maybe-uninitialized)
endif()
# Highway compiles each kernel once for every instruction set. SSE2, AVX2 and AVX-512 serve every x86 processor; the
# others between and above them gain nothing here, and double the time of the build.
target_compile_definitions(firstcontact_build_flags INTERFACE
  "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL)")
if(FIRSTCONTACT_WARNINGS_AS_ERRORS)
  target_compile_options(firstcontact_build_flags INTERFACE -Werror)
endif()
if(FIRSTCONTACT_SANITIZERS)
  # The first finding ends the program. Code that could go on after it would also be slower to make and to run.
  add_compile_options(-fsanitize=${FIRSTCONTACT_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FIRSTCONTACT_SANITIZERS})
  if(FIRSTCONTACT_SANITIZERS MATCHES "address.*undefined" AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    # Both are about addresses, which the address sanitizer checks. They would take a third of the time to compile.
    add_compile_options(-fno-sanitize=object-size,pointer-overflow)
  endif()
endif()

# Vector kernels that are inlined whole take clang ten minutes with a check of every address, which the address
# sanitizer makes, too.
function(firstcontact_relax_sanitizers file)
  if(FIRSTCONTACT_SANITIZERS MATCHES undefined AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    set_property(SOURCE ${file} APPEND PROPERTY
      COMPILE_OPTIONS -fno-sanitize=pointer-overflow,null,alignment,object-size,bounds)
  endif()
  if(FIRSTCONTACT_SANITIZERS MATCHES address AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    # Checks of addresses as calls, not inlined: a fifth of the time to compile.
    set_property(SOURCE ${file} APPEND PROPERTY
      COMPILE_OPTIONS -mllvm -asan-instrumentation-with-call-threshold=0)
  endif()
endfunction()
