# Flags that every target shares, as one interface target.
add_library(meniscus_options INTERFACE)
add_library(meniscus::options ALIAS meniscus_options)
target_compile_features(meniscus_options INTERFACE cxx_std_20)
# Designated initializers leave the rest at its default, which is the point.
target_compile_options(meniscus_options INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wshadow -Wnon-virtual-dtor
  -Wno-missing-field-initializers>)
# g++ 12 at -O3 sees reads past fixed-size Eigen vectors and copies of 2^63 bytes
# in std::string where there are none: screens of it in a first build.
target_compile_options(meniscus_options INTERFACE
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds
  -Wno-restrict -Wno-stringop-overflow>>)
# Of several files compiled as one (the presets do), none is the main file: what
# is local to one of them looks as if a header held it.
if(CMAKE_UNITY_BUILD)
  target_compile_options(meniscus_options INTERFACE
    $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>>)
endif()
# g++ collects garbage each time its heap has grown by a third, and marks the
# precompiled header's heap anew: a fifth of a compilation. 1 GB first.
target_compile_options(meniscus_options INTERFACE
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:
  --param=ggc-min-heapsize=1000000 --param=ggc-min-expand=200>>)
# -fPIC everywhere: one precompiled header serves libraries and programs.
target_compile_options(meniscus_options INTERFACE
  -march=${MENISCUS_MARCH} -fPIC)
# Debian's Ceres and VTK are built for plain x86-64. Eigen chooses alignment,
# and with it the allocator, by instruction set; one fixed value keeps Eigen
# objects exchangeable with those libraries.
# Eigen's own threads sum products in another order than one thread does, and
# start for products of a few rows.
target_compile_definitions(meniscus_options INTERFACE
  EIGEN_MAX_ALIGN_BYTES=16 EIGEN_DONT_PARALLELIZE)
target_include_directories(meniscus_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/meniscus>)

# meniscus_add_room(FOLDER SOURCES ... [ROOMS folders ...] [PUBLIC targets ...]
#                   [PRIVATE targets ...])
# A folder of sources is a static library: core/math is meniscus::core_math.
# ROOMS: the folders that its sources include from, all of them; what
# tests/rules/include_rule reads.
function(meniscus_add_room folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;ROOMS;PUBLIC;PRIVATE" ${ARGN})
  string(REPLACE "/" "_" name ${folder})
  list(TRANSFORM ARG_ROOMS REPLACE "/" "_")
  list(TRANSFORM ARG_ROOMS PREPEND meniscus::)
  add_library(meniscus_${name} STATIC ${ARG_SOURCES})
  add_library(meniscus::${name} ALIAS meniscus_${name})
  target_link_libraries(meniscus_${name}
    PUBLIC meniscus_options ${ARG_ROOMS} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  set_target_properties(meniscus_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY MENISCUS_LIBRARIES meniscus_${name})
  if(NOT name STREQUAL core)
    target_precompile_headers(meniscus_${name} REUSE_FROM meniscus_core)
  endif()
endfunction()

# meniscus_add_column(NAME folder ...): all rooms of a column as one target.
function(meniscus_add_column name)
  list(TRANSFORM ARGN REPLACE "/" "_" OUTPUT_VARIABLE rooms)
  list(TRANSFORM rooms PREPEND meniscus::)
  add_library(meniscus_${name} INTERFACE)
  add_library(meniscus::${name} ALIAS meniscus_${name})
  target_link_libraries(meniscus_${name} INTERFACE ${rooms})
  set_target_properties(meniscus_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY MENISCUS_LIBRARIES meniscus_${name})
endfunction()

# meniscus_link_rooms(TARGET [LEVEL]): a test's program or library; LEVEL of
# optimisation is O0 or O2. Tests link shared libraries of the rooms
# (MENISCUS_TEST_ROOMS, tests/CMakeLists.txt) and are compiled for a quick build,
# not for quick tests: what they measure is in the library. It binds its own
# symbols, so no inline function of a test stands in for one of ours (decision
# 0017).
function(meniscus_link_rooms target)
  set(level ${ARGN})
  if(NOT level)
    set(level O0)
  endif()
  target_link_libraries(${target} PUBLIC ${MENISCUS_TEST_ROOMS})
  target_compile_options(${target} PRIVATE -${level})
  target_compile_definitions(${target}
    PRIVATE MENISCUS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_precompile_headers(${target} REUSE_FROM meniscus_test_headers_${level})
endfunction()

# meniscus_add_test(NAME SOURCES ... [LINK targets ...] [LABELS ...] [TIMEOUT s]
#                   [LEVEL O2] [ALONE] [TOGETHER])
# One GoogleTest program, each of its cases a CTest test; ALONE: with no other
# test beside it, for tests of speed. TOGETHER: all cases in one process, for
# programs of many cases shorter than their start.
function(meniscus_add_test name)
  cmake_parse_arguments(ARG "ALONE;TOGETHER" "TIMEOUT;LEVEL" "SOURCES;LINK;LABELS"
    ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  meniscus_link_rooms(${name} ${ARG_LEVEL})
  target_link_libraries(${name}
    PRIVATE meniscus_test_support ${ARG_LINK} GTest::gmock GTest::gtest_main)
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(ARG_ALONE)
    set(alone RUN_SERIAL TRUE)
  endif()
  if(ARG_LABELS)
    set(labels LABELS "${ARG_LABELS}")
  endif()
  set(properties TIMEOUT ${ARG_TIMEOUT} ${labels} ${alone})
  if(ARG_TOGETHER)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES ${properties})
  else()
    # Values of parameters would put bytes of memory into the tests' names.
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES
      PROPERTIES ${properties})
  endif()
endfunction()
