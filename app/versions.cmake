# MENISCUS_LIBRARY_VERSIONS: "Name version\n..." of every library linked.

# meniscus_header_version(RESULT header pattern...): the first group of each
# pattern, joined with dots. Headers of one library share a search path.
function(meniscus_header_version result header)
  find_file(header_file ${header} NO_CACHE
    PATH_SUFFIXES suitesparse x86_64-linux-gnu ../include/libqhull_r)
  set(parts)
  if(header_file)
    file(READ ${header_file} text)
    foreach(pattern ${ARGN})
      if(text MATCHES "${pattern}")
        list(APPEND parts ${CMAKE_MATCH_1})
      endif()
    endforeach()
  endif()
  list(JOIN parts "." version)
  set(${result} "${version}" PARENT_SCOPE)
endfunction()

meniscus_header_version(cholmod_version cholmod_core.h
  "CHOLMOD_MAIN_VERSION ([0-9]+)" "CHOLMOD_SUB_VERSION ([0-9]+)"
  "CHOLMOD_SUBSUB_VERSION ([0-9]+)")
meniscus_header_version(metis_version metis.h
  "METIS_VER_MAJOR +([0-9]+)" "METIS_VER_MINOR +([0-9]+)"
  "METIS_VER_SUBMINOR +([0-9]+)")
meniscus_header_version(openblas_version openblas_config.h
  "OPENBLAS_VERSION \" *OpenBLAS ([0-9.]+)")
meniscus_header_version(toml_version toml++/toml.h
  "TOML_LIB_MAJOR[ \t]+([0-9]+)" "TOML_LIB_MINOR[ \t]+([0-9]+)"
  "TOML_LIB_PATCH[ \t]+([0-9]+)")
if(NOT toml_version)
  meniscus_header_version(toml_version toml++/impl/version.h
    "TOML_LIB_MAJOR[ \t]+([0-9]+)" "TOML_LIB_MINOR[ \t]+([0-9]+)"
    "TOML_LIB_PATCH[ \t]+([0-9]+)")
endif()
meniscus_header_version(cli11_version CLI/Version.hpp
  "CLI11_VERSION \"([0-9.]+)\"")
meniscus_header_version(lib3mf_version lib3mf/Model/COM/NMR_COMVersion.h
  "INTERFACE_MAJOR +([0-9]+)" "INTERFACE_MINOR +([0-9]+)"
  "INTERFACE_MICRO +([0-9]+)")
# These name no version in a header; Debian 12 ships exactly one.
set(tetgen_version "1.5.0")
set(udunits_version "2.2.28")
set(qhull_version "2020.2")

set(MENISCUS_LIBRARY_VERSIONS "")
foreach(entry
    "Eigen ${Eigen3_VERSION}" "TetGen ${tetgen_version}"
    "NLopt ${NLOPT_VERSION}" "Ceres ${Ceres_VERSION}" "VTK ${VTK_VERSION}"
    "CHOLMOD ${cholmod_version}" "METIS ${metis_version}"
    "OpenBLAS ${openblas_version}" "Qhull ${qhull_version}"
    "SQLite ${SQLite3_VERSION}" "toml++ ${toml_version}"
    "UDUNITS ${udunits_version}" "lib3mf ${lib3mf_version}" "CLI11 ${cli11_version}"
    "fmt ${fmt_VERSION}" "nlohmann-json ${nlohmann_json_VERSION}")
  string(APPEND MENISCUS_LIBRARY_VERSIONS "  ${entry}\\n")
endforeach()
configure_file(${CMAKE_CURRENT_SOURCE_DIR}/versions.h.in
               ${CMAKE_CURRENT_BINARY_DIR}/versions.h @ONLY)
