# find_package(pointplane) from an installed tree.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pointplane)

install(EXPORT pointplaneTargets NAMESPACE pointplane:: DESTINATION ${package_dir})
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/pointplane-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config-version.cmake COMPATIBILITY SameMinorVersion)
install(
  FILES ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config.cmake
        ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config-version.cmake
  DESTINATION ${package_dir})
