# Everything comes from Debian 12 by package name (scripts/lib.sh lists them).
find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers only
find_package(Ceres REQUIRED)
find_package(NLopt REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(VTK 9.1 REQUIRED COMPONENTS
  CommonCore CommonDataModel FiltersCore FiltersGeometry FiltersGeneral
  FiltersSources IOXML IOGeometry IOImage RenderingCore RenderingOpenGL2
  RenderingAnnotation RenderingFreeType InteractionStyle)

# Only for the helper meniscus-step; its targets bring what they stand on, but not
# their headers.
find_package(OpenCASCADE REQUIRED)
if(NOT TARGET deps::opencascade)
  add_library(deps::opencascade INTERFACE IMPORTED GLOBAL)
  target_include_directories(deps::opencascade SYSTEM
    INTERFACE ${OpenCASCADE_INCLUDE_DIR})
  target_link_libraries(deps::opencascade
    INTERFACE TKXDESTEP TKXCAF TKSTEP TKBO TKTopAlgo TKMesh)
endif()

# meniscus_find_library(TARGET header library...): an imported target for a
# package that ships neither a CMake nor a pkg-config file.
function(meniscus_find_library target header)
  if(TARGET ${target})
    return()
  endif()
  string(MAKE_C_IDENTIFIER ${target} id)
  find_path(${id}_INCLUDE_DIR ${header} PATH_SUFFIXES suitesparse lib3mf
    REQUIRED)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${${id}_INCLUDE_DIR})
  foreach(library ${ARGN})
    find_library(${id}_${library}_LIBRARY ${library} REQUIRED)
    target_link_libraries(${target} INTERFACE ${${id}_${library}_LIBRARY})
  endforeach()
endfunction()
meniscus_find_library(deps::cholmod cholmod.h cholmod metis openblas)
# Debian's Ceres names ATLAS, whose kernels would then serve CHOLMOD as well. One
# BLAS for all, OpenBLAS, which has LAPACK in it: other bits and slower otherwise.
get_target_property(ceres_links Ceres::ceres INTERFACE_LINK_LIBRARIES)
list(FILTER ceres_links EXCLUDE REGEX "/lib(lapack|blas|f77blas|atlas)\\.so")
set_target_properties(Ceres::ceres PROPERTIES
  INTERFACE_LINK_LIBRARIES "${ceres_links};deps::cholmod")
meniscus_find_library(deps::tetgen tetgen.h tet)
meniscus_find_library(deps::udunits udunits2.h udunits2)
meniscus_find_library(deps::qhull libqhull_r/libqhull_r.h qhull_r)
meniscus_find_library(deps::lib3mf Model/COM/NMR_DLLInterfaces.h 3MF)
meniscus_find_library(deps::toml toml++/toml.h)
meniscus_find_library(deps::cli11 CLI/CLI.hpp)

# Only for the helper meniscus-petsc; without it the solver petsc is refused.
pkg_check_modules(PETSC IMPORTED_TARGET GLOBAL PETSc>=3.18 mpi-c)
if(PETSC_FOUND)
  add_library(deps::petsc ALIAS PkgConfig::PETSC)
else()
  message(STATUS "PETSc not found: no solver 'petsc' (libpetsc-real-dev)")
endif()

if(MENISCUS_BUILD_TESTS)
  include(GoogleTest)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
endif()
