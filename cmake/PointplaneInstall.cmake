# What is installed beside programs and libraries: configurations, documents, and the files by which
# find_package(pointplane) finds it all.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pointplane)

install(EXPORT pointplaneTargets NAMESPACE pointplane:: DESTINATION ${package_dir} COMPONENT dev)
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/pointplane-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config-version.cmake COMPATIBILITY SameMinorVersion)
install(
  FILES ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config.cmake
        ${CMAKE_CURRENT_BINARY_DIR}/pointplane-config-version.cmake
  DESTINATION ${package_dir} COMPONENT dev)

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
install(FILES config.ini config-fast.ini config-paper.ini
        DESTINATION ${CMAKE_INSTALL_DATADIR}/pointplane COMPONENT tools)
# With all that they link to.
set(doc_dir ${CMAKE_INSTALL_DATADIR}/doc/pointplane-doc)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE config.ini config-fast.ini config-paper.ini
        DESTINATION ${doc_dir} COMPONENT doc)
install(FILES tests/consumer/main.cpp tests/consumer/CMakeLists.txt
        DESTINATION ${doc_dir}/tests/consumer COMPONENT doc)
install(DIRECTORY docs DESTINATION ${doc_dir} COMPONENT doc
        FILES_MATCHING PATTERN "*.md" PATTERN "*.ini" PATTERN "*.jpg" PATTERN "*.png" PATTERN "*.svg")
include(cmake/PointplanePackages.cmake)
