# glint_library(NAME SOURCES a.cc … [APART b.cc …] [DEPENDS glint_x …] [USES Ceres::ceres …])
#   APART    sources that GLINT_UNITY does not join with others: names within them would meet
#   DEPENDS  Glint libraries and header-light packages that public headers show
#   USES     packages that only the .cc files see
function(glint_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;APART;DEPENDS;USES" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES} ${ARG_APART})
    set_target_properties(${name} PROPERTIES UNITY_BUILD ${GLINT_UNITY} UNITY_BUILD_BATCH_SIZE 8)
    set_property(SOURCE ${ARG_APART} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
    target_link_libraries(${name} PUBLIC glint_compile_options ${ARG_DEPENDS} PRIVATE ${ARG_USES})
    glint_reuse_headers(${name} ${ARG_DEPENDS} ${ARG_USES})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE glint_compile_options ${ARG_DEPENDS})
  endif()
endfunction()

# What a user runs, without tests and benchmarks: cmake --build … --target programs
add_custom_target(programs)
# The same without what only developers run: what ./dev demo waits for.
add_custom_target(user_programs)

# glint_program(glint-calib SOURCES main_calib.cc DEPENDS … [FOR_DEVELOPERS]): a program in build/bin
function(glint_program name)
  cmake_parse_arguments(ARG "FOR_DEVELOPERS" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE glint_compile_options ${ARG_DEPENDS})
  glint_reuse_headers(${name} ${ARG_DEPENDS})
  target_compile_definitions(${name} PRIVATE GLINT_VERSION="${PROJECT_VERSION}")
  add_dependencies(programs ${name})
  if(NOT ARG_FOR_DEVELOPERS)
    add_dependencies(user_programs ${name})
  endif()
  install(TARGETS ${name} RUNTIME DESTINATION bin)
endfunction()

# glint_test(test_x SOURCES … DEPENDS …): one GoogleTest binary, its cases known to ctest.
function(glint_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE glint_compile_options ${ARG_DEPENDS} GTest::gtest_main GTest::gmock)
  target_compile_definitions(${name} PRIVATE
    GLINT_SOURCE_DIR="${PROJECT_SOURCE_DIR}" GLINT_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  if(glint_torch IN_LIST ARG_DEPENDS)
    target_precompile_headers(${name} REUSE_FROM glint_torch_headers)
  else()
    target_compile_options(${name} PRIVATE ${glint_test_options})
    target_precompile_headers(${name} REUSE_FROM glint_test_headers)
  endif()
  # One process per binary and not per case: starting torch or OpenCV costs more than most cases.
  add_test(NAME ${name} COMMAND ${name})
endfunction()

# glint_benchmark(bench_x SOURCES … DEPENDS …): a program that prints the ratio of two sides.
function(glint_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  if(GLINT_BENCHMARKS)
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE glint_compile_options ${ARG_DEPENDS})
    glint_reuse_headers(${name} ${ARG_DEPENDS})
  endif()
endfunction()
