# Installs the npm packages of SOURCE into FOLDER, in the versions of its package-lock.json. Scripts of packages are not
# run: none is needed.
file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" DESTINATION "${FOLDER}")
execute_process(
  COMMAND "${NPM}" ci --omit=dev --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
  WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE failed OUTPUT_VARIABLE log ERROR_VARIABLE log)
if(failed)
  message(FATAL_ERROR "The npm packages of the pages could not be installed:\n${log}\n"
    "This needs the network once, or packages in npm's cache. "
    "-DREEB_WEB=OFF builds the program without pages (`reeb report`, `reeb view`).")
endif()
file(TOUCH "${FOLDER}/packages.stamp")
