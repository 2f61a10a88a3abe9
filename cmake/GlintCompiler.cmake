# Compiler settings that every target shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Programs are compiled like libraries, so that both can use the same compiled headers.
set(CMAKE_CXX_COMPILE_OPTIONS_PIE ${CMAKE_CXX_COMPILE_OPTIONS_PIC})
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # Without the leniency ccache passes over all that uses compiled headers.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# Which warnings a compiler gives changes with its version: users build whatever it says.
option(GLINT_WARNINGS_ARE_ERRORS "Stop at a compiler's warning (preset developer)" OFF)

# Results are byte-identical on one machine for any thread count: no contraction the compiler may or
# may not do, no reassociation.
add_library(glint_compile_options INTERFACE)
# g++ 12 sees these four where there are none, in std::string of its own (GCC bugs 105651, 105329).
target_compile_options(glint_compile_options INTERFACE
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wshadow;$<$<BOOL:${GLINT_WARNINGS_ARE_ERRORS}>:-Werror>>"
  "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>>"
  # GCC 13 and later: a const string argument is not what a reference that a function returns is to.
  "$<BUILD_INTERFACE:$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference>>"
  "$<BUILD_INTERFACE:-ffp-contract=off;-fno-math-errno>")
target_compile_features(glint_compile_options INTERFACE cxx_std_20)
target_include_directories(glint_compile_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/glint>)
