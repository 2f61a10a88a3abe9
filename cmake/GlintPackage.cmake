# What an installed Glint consists of, and its Debian package (./dev package).
#
#   bin/glint, bin/glint-*        programs (GlintTargets.cmake)
#   share/glint/models            trained weights; programs look here (fitting/weights/find_model.cc)
#   share/glint/schemas           of manifests
#   share/man, share/*completion  from what the programs say of themselves (target package_texts)
include(GNUInstallDirs)

file(GLOB glint_models CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fitting/models/*.safetensors)
install(FILES ${glint_models} DESTINATION share/glint/models)
install(FILES pipeline/contract/manifest.schema.json DESTINATION share/glint/schemas)
install(DIRECTORY workflow DESTINATION share/glint)
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
install(DIRECTORY ${texts}/ DESTINATION share OPTIONAL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME glint)
set(CPACK_PACKAGE_CONTACT "Glint developers <glint@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "relightable material maps from flash photographs")
set(CPACK_PACKAGE_DESCRIPTION "Glint turns flash photographs of a flat material sample into SVBRDF
maps (normal, diffuse, roughness, specular) and into materials for glTF, MaterialX, USD and Blender.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Stages are run by Ninja; poses without a board come from COLMAP.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "ninja-build")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "colmap")
include(CPack)
