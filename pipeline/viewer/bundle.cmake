# Makes viewer_bundle.inc: the bundle's bytes as string literals, none where it cannot be made.
function(finish text)
  file(WRITE ${OUTPUT}.new "${text}")
  file(RENAME ${OUTPUT}.new ${OUTPUT})
endfunction()

function(go_without reason)
  message("The report will have no viewer: ${reason}. For it, install node and npm and have them reach "
          "the npm registry once (or fill its cache: npm ci in pipeline/viewer), then build again.")
  finish("")
endfunction()

if(NOT NPM)
  go_without("npm was not found")
  return()
endif()
file(MAKE_DIRECTORY ${WORK})
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/src DESTINATION ${WORK})
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline
                WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE why)
if(NOT failed)
  execute_process(COMMAND ${NPM} run --silent build WORKING_DIRECTORY ${WORK}
                  RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE why)
endif()
if(failed)
  string(REGEX REPLACE "\n.*" "" why "${why}")
  go_without("npm says: ${why}")
  return()
endif()
file(READ ${WORK}/viewer.bundle.js bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
finish("${bytes}")
