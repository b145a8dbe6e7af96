# Builds the report page WEB into the file PAGE, in the folder WORK: npm fetches
# what package-lock.json names, Vite makes one HTML file. Without npm, or where
# it fails, PAGE is empty, the program says that it holds no page, and the next
# build tries again (STAMP is not there).
function(leave_out reason)
  message(WARNING "The report page is left out of the program: ${reason}")
  file(WRITE ${PAGE} "")
endfunction()

if(NOT NPM)
  leave_out("npm is not installed (Debian packages nodejs and npm).")
  file(TOUCH ${STAMP})
  return()
endif()
file(REMOVE ${STAMP})
file(MAKE_DIRECTORY ${WORK})
foreach(name package.json package-lock.json tsconfig.json vite.config.ts
        index.html)
  configure_file(${WEB}/${name} ${WORK}/${name} COPYONLY)
endforeach()
file(REMOVE_RECURSE ${WORK}/src ${WORK}/dist)
file(COPY ${WEB}/src DESTINATION ${WORK})
# What was fetched for the same lock file serves again.
file(SHA256 ${WEB}/package-lock.json lock)
set(fetched ${WORK}/node_modules/.${lock})
if(NOT EXISTS ${fetched})
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline
      --fetch-retries=1 --fetch-timeout=60000
    WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result
    OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    leave_out("npm ci failed:\n${output}")
    return()
  endif()
  file(TOUCH ${fetched})
endif()
execute_process(COMMAND ${NPM} run --silent build
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result
  OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "The report page cannot be built:\n${output}")
endif()
configure_file(${WORK}/dist/index.html ${PAGE} COPYONLY)
file(TOUCH ${STAMP})
