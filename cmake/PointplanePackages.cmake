# Debian packages, by `cpack` in the build folder: pointplane (the programs), libpointplane-dev,
# python3-pointplane and pointplane-doc.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pointplane)
set(CPACK_PACKAGE_VENDOR "the pointplane authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_CONTACT "the pointplane authors <pointplane@localhost.localdomain>"
    CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE "")
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS OFF)
# Each component's own files for dpkg: copyright, changelog, stripped libraries, compressed pages, permissions.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/finish_debian_tree.cmake)
set(CPACK_POINTPLANE_SOURCE_DIR ${PROJECT_SOURCE_DIR})
set(CPACK_POINTPLANE_STRIP ${CMAKE_STRIP})
set(CPACK_COMPONENTS_ALL tools dev doc)
if(TARGET pointplane_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()

# pointplane_package(COMPONENT NAME SECTION DESCRIPTION...): the first line is the summary.
macro(pointplane_package component name section description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${description}")
endmacro()

set(about "pointplane estimates the motion of a depth camera from noisy points and
planes, with a covariance for every frame. It reads and writes MRPT rawlogs.")
pointplane_package(tools pointplane science
"RGB-D visual odometry with covariances
${about}
.
Programs: odometry, evaluation of trajectories and covariances, conversion
of TUM sequences, simulation, recording.")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "pointplane-doc, mrpt-apps")

pointplane_package(dev libpointplane-dev libdevel
"RGB-D visual odometry with covariances (development files)
${about}
.
Static libraries, headers and the files for CMake's find_package(pointplane).")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "libeigen3-dev, libopencv-dev, libmrpt-obs-dev, zlib1g-dev, libdeflate-dev, libturbojpeg0-dev")
if(OpenNI2_FOUND)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libopenni2-dev")
endif()
if(freenect_FOUND)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libfreenect-dev")
endif()
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS pointplane-doc)

pointplane_package(doc pointplane-doc doc
"RGB-D visual odometry with covariances (documentation)
${about}
.
Documents in Markdown: theory, configuration, formats, accuracy,
consistency.")
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)

pointplane_package(python python3-pointplane python
"RGB-D visual odometry with covariances (Python module)
${about}
.
The odometry and the reader of rawlogs for Python, with NumPy arrays.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${POINTPLANE_PYTHON_DEPENDS}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS pointplane)
include(CPack)
