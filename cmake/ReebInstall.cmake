# find_package(reeb) after `cmake --install`: targets reeb::reeb, reeb::io, reeb::ooc.
include(CMakePackageConfigHelpers)

install(TARGETS reeb reeb_file reeb_io reeb_ooc EXPORT reebTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS reeb_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(folder libreeb io ooc)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/reeb FILES_MATCHING PATTERN "*.h")
endforeach()
install(EXPORT reebTargets NAMESPACE reeb:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/reeb)
configure_package_config_file(cmake/reebConfig.cmake.in reebConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/reeb)
write_basic_package_version_file(reebConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/reebConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/reebConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/reeb)
