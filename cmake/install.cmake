# What `cmake --install` leaves: the program, its helpers (their folders say
# so), and the package that find_package(meniscus) finds.
include(CMakePackageConfigHelpers)
set(MENISCUS_PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/meniscus)
set_target_properties(meniscus_options PROPERTIES EXPORT_NAME options)
install(TARGETS meniscus_options EXPORT meniscusTargets)
get_property(libraries GLOBAL PROPERTY MENISCUS_LIBRARIES)
install(TARGETS ${libraries} EXPORT meniscusTargets)
foreach(folder core evolve mesh_tet fea optimize cad io pipeline report)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meniscus
    FILES_MATCHING PATTERN "*.h" PATTERN web EXCLUDE)
endforeach()
install(EXPORT meniscusTargets NAMESPACE meniscus::
  DESTINATION ${MENISCUS_PACKAGE_FOLDER})
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/meniscusConfig.cmake.in
  ${PROJECT_BINARY_DIR}/meniscusConfig.cmake
  INSTALL_DESTINATION ${MENISCUS_PACKAGE_FOLDER})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/meniscusConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/meniscusConfig.cmake
  ${PROJECT_BINARY_DIR}/meniscusConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/dependencies.cmake
  DESTINATION ${MENISCUS_PACKAGE_FOLDER})
