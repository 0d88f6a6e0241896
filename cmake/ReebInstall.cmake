# find_package(reeb) after `cmake --install`: targets reeb::reeb, reeb::file, reeb::io, reeb::ooc and
# reeb::compute, which are its components, too.
include(CMakePackageConfigHelpers)
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/reeb")

install(TARGETS reeb reeb_file reeb_io reeb_ooc reeb_compute EXPORT reebTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
if(REEB_PROGRAM)
  if(BUILD_SHARED_LIBS)
    # Finds them wherever the prefix is moved.
    file(RELATIVE_PATH libraries "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
    set_target_properties(reeb_program PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
    if(TARGET reeb_mpi)
      set_target_properties(reeb_mpi PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
    endif()
  endif()
  install(TARGETS reeb_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  if(TARGET reeb_mpi)
    # Of no Debian package: it needs the MPI that it was built with.
    install(TARGETS reeb_mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT mpi)
  endif()
  if(REEB_WEB)
    install(FILES "${PROJECT_BINARY_DIR}/web/viewer.html" DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/reeb
      COMPONENT program)
  endif()
endif()
foreach(name IN LISTS reeb_public_headers)
  install(FILES "${PROJECT_BINARY_DIR}/include/reeb/${name}.h" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/reeb
    COMPONENT dev)
endforeach()
install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/reeb COMPONENT program)

install(EXPORT reebTargets NAMESPACE reeb:: DESTINATION ${package} COMPONENT dev)
configure_package_config_file(cmake/reebConfig.cmake.in reebConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(reebConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/reebConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/reebConfigVersion.cmake
  DESTINATION ${package} COMPONENT dev)
