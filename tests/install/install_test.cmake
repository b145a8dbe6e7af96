# Installs the built tree BUILD into the fresh folder WORK, then configures,
# builds and runs the outside project against it, on the case CASE.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result
    OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${result}:\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/outside -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/outside)
# The prefix is not the configured one, so only the variable leads there.
run(${CMAKE_COMMAND} -E env
  MENISCUS_TETGEN=${prefix}/${LIBEXEC}/meniscus/meniscus-tetgen
  ${WORK}/outside/outside ${CASE})
run(${prefix}/${BIN}/meniscus check ${CASE})
# It finds its helpers below the prefix: the mesher, and what writes STEP.
run(${prefix}/${BIN}/meniscus run ${CASE} --out ${WORK}/run --no-pictures
  --no-report --set resolution.fea=24 --set resolution.film=12)
run(${prefix}/${BIN}/meniscus export ${WORK}/run --format step
  --out ${WORK}/part.step)
if(NOT EXISTS ${WORK}/part.step)
  message(FATAL_ERROR "no part.step")
endif()
# The package finds the mesher below the prefix by itself.
if(PYTHON)
  run(${CMAKE_COMMAND} -E env --unset=MENISCUS_TETGEN
    PYTHONPATH=${prefix}/${PYTHON_FOLDER} ${PYTHON} ${IMPORT} ${CASE} ${prefix})
endif()
