# The one place for compiler flags: every target links reeb_flags privately.
add_library(reeb_flags INTERFACE)
target_compile_features(reeb_flags INTERFACE cxx_std_20)
target_compile_options(reeb_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough
  # Sums and means must not depend on whether the machine can fuse a multiply with an add.
  -ffp-contract=off)
# GCC 12 sees uninitialized values in inlined standard containers once sanitizers rewrite them; the
# plain build keeps the warning. -Wnull-dereference is used nowhere: it sees null in a vector's growth.
if(REEB_SANITIZE)
  target_compile_options(reeb_flags INTERFACE
    -fsanitize=${REEB_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    -Wno-maybe-uninitialized)
  # These three take a third of the time to compile. Null pointers crash by themselves, the address sanitizer sees what
  # is outside an object, and there are no downcasts.
  if(REEB_SANITIZE MATCHES "undefined")
    target_compile_options(reeb_flags INTERFACE -fno-sanitize=null,object-size,vptr)
  endif()
  target_link_options(reeb_flags INTERFACE -fsanitize=${REEB_SANITIZE})
endif()
# Of joined sources, each is in the scope of the ones before.
if(REEB_JOIN_SOURCES)
  target_compile_options(reeb_flags INTERFACE -Wno-subobject-linkage -Wno-shadow)
endif()
if(REEB_LIBFUZZER)
  target_compile_options(reeb_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(REEB_WERROR)
  target_compile_options(reeb_flags INTERFACE -Werror)
endif()
target_include_directories(reeb_flags INTERFACE "${PROJECT_SOURCE_DIR}")

# reeb_join(TARGET): with REEB_JOIN_SOURCES, the sources of a room are compiled as one, at most eight at a time. Code for
# inlined functions is made once, which halves the time of a build with sanitizers and saves a third of others. Names in
# unnamed namespaces of a room must differ then.
function(reeb_join target)
  if(NOT REEB_JOIN_SOURCES)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME room)
    math(EXPR group_${room} "${group_${room}} + 1")
    math(EXPR part "${group_${room}} / 8")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room}_${part})
  endforeach()
endfunction()

# reeb_library(NAME sources...): a library target reeb_NAME with the alias reeb::NAME, shared with
# BUILD_SHARED_LIBS. Users see the public headers only (ReebPublicHeaders.cmake).
function(reeb_library name)
  set(target ${name})
  if(NOT name STREQUAL "reeb")
    set(target reeb_${name})
  endif()
  add_library(${target} ${ARGN})
  add_library(reeb::${name} ALIAS ${target})
  # No compatibility between minor versions is promised before 1.0.
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN")
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:reeb_flags>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} INTERFACE
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()
