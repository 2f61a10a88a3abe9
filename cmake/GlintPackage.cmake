# What an installed Glint consists of, and its Debian packages (./dev package): `glint`, and
# `python3-glint`, which only Python's users need.
#
#   bin/glint, bin/glint-*        programs (GlintTargets.cmake)
#   share/glint/models            trained weights; programs look here (fitting/weights/find_model.cc)
#   share/glint/schemas           of manifests
#   share/applications, share/icons  Glint Studio in a desktop's menu
#   share/man, share/*completion  from what the programs say of themselves (target package_texts)
#
#   lib/python3/dist-packages/glint   component `python`, the package python3-glint (python/CMakeLists.txt)
#
# and, as the component `development`, which the packages leave out (cmake --install build
# --component development --prefix DIR), what find_package(Glint) needs:
#
#   include/glint                 public headers, under the paths that the sources use
#   lib/libglint_*.a, lib/cmake/Glint
include(GNUInstallDirs)

file(GLOB glint_models CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fitting/models/*.safetensors)
install(FILES ${glint_models} DESTINATION share/glint/models)
install(FILES base/formats/manifest.schema.json DESTINATION share/glint/schemas)
install(DIRECTORY workflow DESTINATION share/glint)
install(FILES pipeline/studio/desktop/glint-studio.desktop DESTINATION share/applications)
install(FILES pipeline/studio/app/src/icon.svg DESTINATION share/icons/hicolor/scalable/apps
  RENAME glint-studio.svg)
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs FILES_MATCHING PATTERN "*.md")

set(texts ${CMAKE_BINARY_DIR}/package_texts)
set(glint ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/glint)
add_custom_target(package_texts
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${texts}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${texts}/bash-completion/completions
    ${texts}/zsh/vendor-completions ${texts}/fish/vendor_completions.d
  COMMAND ${glint} completion bash > ${texts}/bash-completion/completions/glint
  COMMAND ${glint} completion zsh > ${texts}/zsh/vendor-completions/_glint
  COMMAND ${glint} completion fish > ${texts}/fish/vendor_completions.d/glint.fish
  COMMAND ${glint} manual ${texts}/man/man1
  COMMENT "Writing completion scripts and manual pages"
  VERBATIM)
add_dependencies(package_texts programs)
if(GLINT_PYTHON)
  add_dependencies(package_texts glint_python)
endif()
install(DIRECTORY ${texts}/ DESTINATION share OPTIONAL)

# Libraries that other programs can use, each after those it needs; GlintConfig.cmake.in says what
# packages they need.
function(glint_install_libraries)
  install(TARGETS ${ARGN} glint_compile_options EXPORT GlintTargets
    ARCHIVE DESTINATION lib COMPONENT development)
  foreach(library ${ARGN})
    string(REPLACE glint_ "" name ${library})
    get_target_property(folder ${library} SOURCE_DIR)
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${folder})
    set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
    install(DIRECTORY ${folder}/ DESTINATION include/glint/${path} COMPONENT development
      FILES_MATCHING PATTERN "*.h" PATTERN kernel.h EXCLUDE PATTERN render_autograd.h EXCLUDE
      PATTERN render_reference.h EXCLUDE)  # the kernel's inside; torch's
  endforeach()
endfunction()
glint_install_libraries(glint_cpu glint_memory glint_parallel glint_resampling glint_model
  glint_reflectance glint_render glint_camera glint_board glint_files glint_images glint_photos glint_stages
  glint_formats glint_programs)
set_target_properties(glint_compile_options PROPERTIES EXPORT_NAME compile_options)
install(EXPORT GlintTargets NAMESPACE Glint:: DESTINATION lib/cmake/Glint COMPONENT development)
include(CMakePackageConfigHelpers)
configure_package_config_file(cmake/GlintConfig.cmake.in ${CMAKE_BINARY_DIR}/GlintConfig.cmake
  INSTALL_DESTINATION lib/cmake/Glint)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/GlintConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/GlintConfig.cmake ${CMAKE_BINARY_DIR}/GlintConfigVersion.cmake
  DESTINATION lib/cmake/Glint COMPONENT development)

set(CPACK_COMPONENTS_ALL Unspecified)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME glint)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME glint)
set(CPACK_PACKAGE_CONTACT "Glint developers <glint@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "relightable material maps from flash photographs")
set(CPACK_PACKAGE_DESCRIPTION "Glint turns flash photographs of a flat material sample into SVBRDF
maps (normal, diffuse, roughness, specular) and into materials for glTF, MaterialX, USD and Blender.")
set(CPACK_COMPONENT_UNSPECIFIED_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Stages are run by Ninja; poses without a board come from COLMAP.
# libtorch alone is content with the reference BLAS, the slowest.
set(CPACK_DEBIAN_PACKAGE_DEPENDS
  "ninja-build, libopenblas0-serial | libopenblas0-pthread | libopenblas0-openmp")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "colmap, xdg-utils")
if(GLINT_PYTHON)
  # Packages are of the interpreter that the module was compiled for.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_COMPONENTS_ALL Unspecified python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-glint)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "glint (= ${PROJECT_VERSION}), python3-numpy, \
python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${next_minor})")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    "${PROJECT_SOURCE_DIR}/cmake/python3-glint/postinst;${PROJECT_SOURCE_DIR}/cmake/python3-glint/prerm")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Glint for Python: captures and maps as NumPy arrays, the
differentiable renderer, and the pipeline with progress and errors.")
endif()
include(CPack)
