# The pages of the program, made of tools/web and tools/viewer with packages from npm and put into the program as text.
#
# Packages are installed into the build folder, in the versions of tools/web/package-lock.json. With REEB_WEB=OFF
# nothing of this is needed, and commands that need a page say that they have none.
function(reeb_web_pages)
  set(folder "${PROJECT_BINARY_DIR}/web")
  set(pages "${folder}/pages.cpp")
  if(REEB_WEB)
    find_program(REEB_NODE NAMES node nodejs DOC "Node.js, for REEB_WEB")
    find_program(REEB_NPM NAMES npm DOC "npm, for REEB_WEB")
    mark_as_advanced(REEB_NODE REEB_NPM)
    if(NOT REEB_NODE OR NOT REEB_NPM)
      message(FATAL_ERROR "Node.js or npm is missing, with which the pages of `reeb report` and `reeb view` are made. "
        "tools/install_packages.sh installs them; -DREEB_WEB=OFF builds the program without pages.")
    endif()
    set(source "${PROJECT_SOURCE_DIR}/tools/web")
    add_custom_command(OUTPUT "${folder}/packages.stamp"
      COMMAND ${CMAKE_COMMAND} "-DNPM=${REEB_NPM}" "-DSOURCE=${source}" "-DFOLDER=${folder}"
        -P "${PROJECT_SOURCE_DIR}/cmake/install_web_packages.cmake"
      DEPENDS "${source}/package.json" "${source}/package-lock.json"
        "${PROJECT_SOURCE_DIR}/cmake/install_web_packages.cmake"
      COMMENT "Installing the npm packages of tools/web" VERBATIM)
    file(GLOB_RECURSE parts CONFIGURE_DEPENDS "${source}/*.js" "${source}/*.mjs" "${source}/*.html" "${source}/*.css"
      "${PROJECT_SOURCE_DIR}/tools/viewer/*")
    # With background threads, Node.js can hang while it awaits a promise and has nothing else to do:
    # https://github.com/nodejs/node/issues/54918
    add_custom_command(OUTPUT "${pages}" BYPRODUCTS "${folder}/viewer.html"
      COMMAND "${REEB_NODE}" --single-threaded "${source}/build.mjs" "${folder}" "${pages}"
      DEPENDS "${folder}/packages.stamp" ${parts}
      COMMENT "Making the pages of tools/web" VERBATIM)
  else()
    set(pages "${folder}/no_pages.cpp")  # another name, so that switching REEB_WEB back makes the pages again
    file(CONFIGURE OUTPUT "${pages}" @ONLY CONTENT [=[// Built with REEB_WEB=OFF: there are no pages.
#include "tools/report/page_template.h"
#include "tools/view/viewer_page.h"
std::string_view reeb::tools::report_template() { return {}; }
std::string_view reeb::tools::viewer_page() { return {}; }
]=])
  endif()
  # Without the flags of the project: its warnings are about sources of people.
  add_library(reeb_pages STATIC "${pages}")
  target_compile_features(reeb_pages PRIVATE cxx_std_20)
  target_include_directories(reeb_pages PRIVATE "${PROJECT_SOURCE_DIR}")
endfunction()
