# The public face: what users include as "reeb/NAME.h", and the files that each of these headers is made of.
#
# Headers live in their layer and include each other from the root of the project. For users they are put
# together, when the project is configured: ${PROJECT_BINARY_DIR}/include/reeb is what a parent project
# includes, what is installed, and what the README shows. A public header that needs anything but the
# standard library and public headers above it fails the configuration: so no user ever needs the headers
# of TBB, Boost or zstd, or one of ours that can change at any time.
set(reeb_public_headers error graph online hierarchy mesh function reeb_file progressive_graph export compute reeb)
set(reeb_public_error libreeb/base/error.h)
set(reeb_public_graph
  libreeb/base/ids.h libreeb/base/sweep_key.h libreeb/graph/settled_node.h libreeb/graph/reeb_graph.h
  libreeb/graph/bucket.h libreeb/graph/arc_buckets.h libreeb/graph/arc_measures.h)
set(reeb_public_online libreeb/port/graph_sink.h libreeb/engine/online_reeb.h)
set(reeb_public_hierarchy
  libreeb/graph/arc_version.h libreeb/hierarchy/hierarchy.h libreeb/hierarchy/pairing.h libreeb/hierarchy/levels.h)
set(reeb_public_mesh
  libreeb/port/simplex_counts.h libreeb/port/grid_reader.h libreeb/port/indexed_mesh.h libreeb/port/mesh_reader.h
  io/formats/open_mesh.h)
set(reeb_public_function libreeb/port/vertex_function.h io/functions/function_spec.h io/functions/function_source.h)
set(reeb_public_reeb_file libreeb/format/file_header.h ooc/reeb_file/reeb_file.h)
set(reeb_public_progressive_graph ooc/reeb_file/progressive_graph.h)
set(reeb_public_export io/export/graph_export.h)
set(reeb_public_compute libreeb/base/value_range.h ooc/run/compute_result.h tools/library/compute.h)
set(reeb_public_reeb tools/library/reeb.h)

# reeb_public_include(LINE PART NAME OUT): what an #include of PART becomes in reeb/NAME.h; empty: nothing.
function(reeb_public_include line part name out)
  if(line MATCHES "<([a-z_0-9]+)>")  # the standard library's names have no suffix and no folder
    set(${out} "${line}" PARENT_SCOPE)
    return()
  endif()
  if(line MATCHES "\"([^\"]+)\"")
    get_property(home GLOBAL PROPERTY "reeb_public_home_${CMAKE_MATCH_1}")
    if(home STREQUAL name)
      set(${out} "" PARENT_SCOPE)
      return()
    elseif(home)
      set(${out} "#include \"reeb/${home}.h\"" PARENT_SCOPE)
      return()
    endif()
  endif()
  message(FATAL_ERROR "${part} is public as reeb/${name}.h, but has `${line}`, which is neither public (see "
    "cmake/ReebPublicHeaders.cmake; the order counts) nor a header of the standard library")
endfunction()

# reeb_make_public_headers(SOURCE_DIR OUTPUT_DIR): OUTPUT_DIR/reeb/NAME.h of each. Files that would stay the
# same are not touched.
function(reeb_make_public_headers source output)
  foreach(name IN LISTS reeb_public_headers)
    set(includes "")
    set(body "")
    foreach(part IN LISTS reeb_public_${name})
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}/${part}")
      file(READ "${source}/${part}" text)
      string(REGEX MATCHALL "\n#[ \t]*include[^\n]*" lines "${text}")
      foreach(line IN LISTS lines)
        string(STRIP "${line}" line)
        reeb_public_include("${line}" "${part}" ${name} line)
        if(line)
          list(APPEND includes "${line}")
        endif()
      endforeach()
      string(REGEX REPLACE "\n#[ \t]*(include|pragma once)[^\n]*" "" text "${text}")
      string(APPEND body "\n${text}")
      set_property(GLOBAL PROPERTY "reeb_public_home_${part}" ${name})
    endforeach()
    list(REMOVE_DUPLICATES includes)
    list(SORT includes)
    list(JOIN includes "\n" includes)
    string(REGEX REPLACE "\n\n\n+" "\n\n" body "${body}")
    set(text "// <reeb/${name}.h>, a part of reeb ${PROJECT_VERSION}.\n#pragma once\n\n${includes}\n${body}")
    set(file "${output}/reeb/${name}.h")
    set(old "")
    if(EXISTS "${file}")
      file(READ "${file}" old)
    endif()
    if(NOT text STREQUAL old)
      file(WRITE "${file}" "${text}")
    endif()
  endforeach()
endfunction()
