# Compiles a target's sources together, eight at a time (those beside a library's LIGHT ones: all).
function(glint_unity name)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${GLINT_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# glint_library(NAME SOURCES a.cc … [LIGHT c.cc …] [APART b.cc …] [DEPENDS glint_x …] [USES Ceres::ceres …])
#   LIGHT    sources that GLINT_UNITY joins with each other alone: programs that need nothing else of
#            the library load none of the packages that SOURCES use, and start in milliseconds
#   APART    sources that GLINT_UNITY does not join with others: names within them would meet
#   DEPENDS  Glint libraries and header-light packages that public headers show
#   USES     packages that only the .cc files see
function(glint_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIGHT;APART;DEPENDS;USES" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES} ${ARG_LIGHT} ${ARG_APART})
    glint_unity(${name})
    set_property(SOURCE ${ARG_APART} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
    if(ARG_LIGHT)
      set_target_properties(${name} PROPERTIES UNITY_BUILD_MODE GROUP)
      set_property(SOURCE ${ARG_LIGHT} PROPERTY UNITY_GROUP light)
      set_property(SOURCE ${ARG_SOURCES} PROPERTY UNITY_GROUP rest)
    endif()
    target_link_libraries(${name} PUBLIC glint_compile_options ${ARG_DEPENDS} PRIVATE ${ARG_USES})
    glint_reuse_headers(${name} ${ARG_DEPENDS} ${ARG_USES})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE glint_compile_options ${ARG_DEPENDS})
  endif()
endfunction()

# glint_vector_kernels(kernel DISPATCH kernel_dispatch.cc OUT kernels): kernel_baseline.cc and, on
# x86, kernel_avx2.cc and kernel_avx512.cc, each compiled for its instruction set; they include
# base/cpu/vectors.inl.
function(glint_vector_kernels name)
  cmake_parse_arguments(ARG "" "DISPATCH;OUT" "" ${ARGN})
  set(kernels ${name}_baseline.cc)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND kernels ${name}_avx2.cc ${name}_avx512.cc)
    set_source_files_properties(${name}_avx2.cc PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma")
    set_source_files_properties(${name}_avx512.cc PROPERTIES
      COMPILE_OPTIONS "-mavx512f;-mavx512dq;-mavx512vl;-mavx512bw;-mavx2;-mfma")
    set_source_files_properties(${ARG_DISPATCH} PROPERTIES COMPILE_DEFINITIONS GLINT_X86_KERNELS)
  endif()
  # Vector types wider than the set's registers never cross a call that is not inlined (-Wno-psabi).
  # The kernels are worth optimising in every build: at less than -O3 they are several times slower.
  set_property(SOURCE ${kernels} APPEND PROPERTY COMPILE_OPTIONS -Wno-psabi -O3)
  # Headers compiled for one instruction set do not serve another.
  set_property(SOURCE ${kernels} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
  set(${ARG_OUT} ${kernels} PARENT_SCOPE)
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
  # Before all else: OpenImageIO's headers define parts of fmt anew, for which the linker would take
  # the objects that read photographs, and with them 250 libraries that take 0.2 s to load.
  target_link_options(${name} PRIVATE
    "LINKER:--push-state,--no-as-needed,$<TARGET_FILE:fmt::fmt>,--pop-state")
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
  glint_unity(${name})
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
