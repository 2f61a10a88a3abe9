# Pages whose scripts npm bundles at build time, as bytes inside the programs.
find_program(NPM_PROGRAM npm)

# glint_npm_bundle(FOLDER dir COPY src … FILES a.js … WITHOUT "text" CARRIER x.cc): bundles `dir` (its `npm run
# build` makes FILES, from COPY beside package.json and package-lock.json), for `x.cc` to include
# each as "a.js.inc". Without npm or its packages the files are empty, and the build says WITHOUT.
function(glint_npm_bundle)
  cmake_parse_arguments(ARG "" "FOLDER;WITHOUT;CARRIER" "COPY;FILES" ${ARGN})
  set(source ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_FOLDER})
  set(outputs "")
  foreach(file ${ARG_FILES})
    get_filename_component(name ${file} NAME)
    list(APPEND outputs ${CMAKE_CURRENT_BINARY_DIR}/${name}.inc)
  endforeach()
  set(patterns ${source}/package.json ${source}/package-lock.json)
  foreach(item ${ARG_COPY})
    if(IS_DIRECTORY ${source}/${item})
      list(APPEND patterns ${source}/${item}/*)
    else()
      list(APPEND patterns ${source}/${item})
    endif()
  endforeach()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${patterns})
  list(JOIN ARG_COPY "|" copy)
  list(JOIN ARG_FILES "|" files)
  add_custom_command(
    OUTPUT ${outputs}
    COMMAND ${CMAKE_COMMAND} -DNPM=${NPM_PROGRAM} -DSOURCE=${source} -DCOPY=${copy}
            -DWORK=${CMAKE_CURRENT_BINARY_DIR}/bundle -DOUTPUT=${CMAKE_CURRENT_BINARY_DIR}
            -DFILES=${files} -DWITHOUT=${ARG_WITHOUT} -P ${PROJECT_SOURCE_DIR}/cmake/npm_bundle.cmake
    DEPENDS ${sources} ${PROJECT_SOURCE_DIR}/cmake/npm_bundle.cmake
    COMMENT "Bundling ${source}"
    VERBATIM)
  set_source_files_properties(${ARG_CARRIER} PROPERTIES OBJECT_DEPENDS "${outputs}")
endfunction()
