# Debian packages of what was built: `cpack` in the build folder writes reeb, libreeb-dev and, with REEB_PYTHON,
# python3-reeb. The library is static, so the program and the Python module contain it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR reeb)
set(CPACK_PACKAGE_CONTACT "the reeb authors <reeb@example.org>" CACHE STRING "The maintainer of the Debian packages")
mark_as_advanced(CPACK_PACKAGE_CONTACT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# By default, cpack compresses by gzip, to larger files.
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# Nothing is stripped by CMake, which leaves out static libraries and comments.
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/packaging/debian/tree.cmake")
set(CPACK_REEB_SOURCE "${PROJECT_SOURCE_DIR}")
set(CPACK_REEB_STRIP "${CMAKE_STRIP}")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME reeb)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "gnuplot-nox, graphviz, librsvg2-bin")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "The program reeb computes the Reeb graph of a function on a mesh, which may
be much larger than memory, with all levels of detail. It measures and
removes noise, finds defects, repairs and segments meshes, and draws graphs.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libreeb-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "libstdc++-12-dev | libstdc++-dev, libzstd-dev, liblz4-dev, zlib1g-dev, libpng-dev, libexpat1-dev, libtbb-dev, libboost-iostreams-dev, pkg-config")
set(CPACK_DEBIAN_DEV_DESCRIPTION "The static C++20 library of the program reeb, its headers, and its files for
CMake and pkg-config: whole runs on files of any size, graphs that grow while
a mesh is made, and a reader that loads graphs level by level.")

if(REEB_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  # The module is of one version of Python.
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-reeb)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packaging/debian/postinst"
    "${PROJECT_SOURCE_DIR}/packaging/debian/prerm")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-networkx, python3-vtk9, python3-tqdm")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The package reeb computes Reeb graphs of files, which it reads as streams, and
of arrays of NumPy, without a copy; with levels of detail, skeletons, pairs,
segmentation, and graphs for networkx, VTK and GUDHI.")
endif()
include(CPack)
