# Headers that cost more to read than the sources that use them are compiled once, and stand before
# every source of a target by themselves. Sources include what they use all the same:
# cmake -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON compiles them so.

# glint_compiled_headers(NAME HEADERS <a> … [USES package …] [OPTIONS -O1 …]): what targets reuse
# with target_precompile_headers(target REUSE_FROM NAME), given the same options.
function(glint_compiled_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;USES;OPTIONS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/${name}.cc CONTENT "// Carries compiled headers.\n")
  add_library(${name} STATIC ${CMAKE_BINARY_DIR}/${name}.cc)
  target_link_libraries(${name} PRIVATE glint_compile_options ${ARG_USES})
  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

# Tests run once, in less time than -O3 takes to compile them; what they test keeps its own options.
set(glint_test_options $<$<CONFIG:Release>:-O1>)

glint_compiled_headers(glint_torch_headers HEADERS <torch/torch.h> USES glint_torch)
if(NOT GLINT_TRAINER_ONLY)
  set(common_headers <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory>
    <optional> <random> <set> <span> <sstream> <string> <vector> <Eigen/Dense> <nlohmann/json.hpp>)
  glint_compiled_headers(glint_common_headers HEADERS ${common_headers}
    USES Eigen3::Eigen nlohmann_json::nlohmann_json)
  if(GLINT_TESTS)
    glint_compiled_headers(glint_test_headers HEADERS ${common_headers} <gmock/gmock.h> <gtest/gtest.h>
      USES Eigen3::Eigen nlohmann_json::nlohmann_json GTest::gtest GTest::gmock OPTIONS ${glint_test_options})
  endif()
endif()

# Has `target` reuse what suits the packages it uses.
function(glint_reuse_headers target)
  if(glint_torch IN_LIST ARGN)
    target_precompile_headers(${target} REUSE_FROM glint_torch_headers)
  elseif(TARGET glint_common_headers)
    target_precompile_headers(${target} REUSE_FROM glint_common_headers)
  endif()
endfunction()
