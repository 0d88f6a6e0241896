# What comes with an installation besides program and library: man pages and completions, made from --help; the file for
# pkg-config; the Python package; Debian packages (ReebDebian.cmake); the pages about the public headers (target docs).

# A library that is not needed by the compiler of a user is private.
set(reeb_pc_private "-lreeb_io -lreeb_ooc -lreeb_file -lreeb")
set(reeb_pc_requires "libzstd liblz4 zlib libpng expat tbb")
file(RELATIVE_PATH reeb_pc_prefix "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
string(REGEX REPLACE "/$" "" reeb_pc_prefix "${reeb_pc_prefix}")
configure_file(packaging/reeb.pc.in reeb.pc @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/reeb.pc" DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

if(REEB_PROGRAM AND NOT CMAKE_CROSSCOMPILING)
  set(help "${PROJECT_BINARY_DIR}/help")
  add_custom_command(OUTPUT "${help}/reeb.fish"
    COMMAND ${CMAKE_COMMAND} -E make_directory "${help}"
    COMMAND bash "${PROJECT_SOURCE_DIR}/packaging/from_help.sh" "$<TARGET_FILE:reeb_program>" "${PROJECT_VERSION}"
      "${help}"
    DEPENDS reeb_program "${PROJECT_SOURCE_DIR}/packaging/from_help.sh"
    COMMENT "Making man pages and completions" VERBATIM)
  add_custom_target(reeb_help ALL DEPENDS "${help}/reeb.fish")
  install(DIRECTORY "${help}/man/" DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program OPTIONAL)
  install(FILES "${help}/reeb.bash" DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions RENAME reeb
    COMPONENT program OPTIONAL)
  install(FILES "${help}/_reeb" DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/vendor-completions COMPONENT program
    OPTIONAL)
  install(FILES "${help}/reeb.fish" DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/fish/vendor_completions.d
    COMPONENT program OPTIONAL)
endif()

if(REEB_PYTHON)
  # Where Debian's Python looks; another prefix needs PYTHONPATH.
  set(folder "lib/python3/dist-packages/reeb")
  install(TARGETS reeb_python LIBRARY DESTINATION ${folder} COMPONENT python OPTIONAL)
  install(DIRECTORY tools/python/reeb/ DESTINATION ${folder} COMPONENT python FILES_MATCHING PATTERN "*.py"
    PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
endif()

find_program(REEB_DOXYGEN doxygen)
mark_as_advanced(REEB_DOXYGEN)
if(REEB_DOXYGEN)
  configure_file(packaging/Doxyfile.in Doxyfile @ONLY)
  add_custom_target(docs COMMAND "${REEB_DOXYGEN}" "${PROJECT_BINARY_DIR}/Doxyfile"
    WORKING_DIRECTORY "${PROJECT_BINARY_DIR}" COMMENT "Writing html/index.html" VERBATIM)
endif()
