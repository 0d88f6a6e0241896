# The one place for compiler flags: every target links reeb_flags privately.
add_library(reeb_flags INTERFACE)
target_compile_features(reeb_flags INTERFACE cxx_std_20)
target_compile_options(reeb_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wnull-dereference -Wimplicit-fallthrough
  # Sums and means must not depend on whether the machine can fuse a multiply with an add.
  -ffp-contract=off)
# GCC 12 sees null pointers and stray bounds in inlined standard containers once sanitizers
# rewrite them; the plain build keeps both warnings.
if(REEB_SANITIZE)
  target_compile_options(reeb_flags INTERFACE
    -fsanitize=${REEB_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    -Wno-null-dereference -Wno-maybe-uninitialized)
  target_link_options(reeb_flags INTERFACE -fsanitize=${REEB_SANITIZE})
endif()
if(REEB_LIBFUZZER)
  target_compile_options(reeb_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(REEB_WERROR)
  target_compile_options(reeb_flags INTERFACE -Werror)
endif()
target_include_directories(reeb_flags INTERFACE "${PROJECT_SOURCE_DIR}")

# reeb_library(NAME sources...): a library target reeb_NAME with the alias reeb::NAME.
function(reeb_library name)
  set(target ${name})
  if(NOT name STREQUAL "reeb")
    set(target reeb_${name})
  endif()
  add_library(${target} STATIC ${ARGN})
  add_library(reeb::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:reeb_flags>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/reeb>)
endfunction()
