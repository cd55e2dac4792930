# find_package(firstcontact) for projects that use the installed library.

include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/firstcontact)
install(EXPORT firstcontactTargets NAMESPACE firstcontact:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/firstcontactConfig.cmake.in
  ${PROJECT_BINARY_DIR}/firstcontactConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 each minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/firstcontactConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/firstcontactConfig.cmake
  ${PROJECT_BINARY_DIR}/firstcontactConfigVersion.cmake
  DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
