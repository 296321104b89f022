# version.h: facts of the configuration, and the git revision in every build, because a commit does not configure anew.
# Included, this file gives the target kapitza_version; that target runs it as a script.

if(CMAKE_SCRIPT_MODE_FILE)
  cmake_path(GET SOURCE PARENT_PATH above)
  set(ENV{GIT_CEILING_DIRECTORIES} ${above}) # a repository around SOURCE is another project's
  execute_process(COMMAND git --no-optional-locks describe --always --dirty --abbrev=10 WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE KAPITZA_GIT_REVISION OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT KAPITZA_GIT_REVISION)
    set(KAPITZA_GIT_REVISION unknown)
  endif()
  configure_file(${INPUT} ${OUTPUT} @ONLY) # an unchanged file keeps its time: nothing is compiled again
  return()
endif()

file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include) # gfortran refuses an include folder that is not there yet
set(KAPITZA_GIT_REVISION "@KAPITZA_GIT_REVISION@") # left for the build
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include/kapitza) # before the first build: a missing include folder is an error
configure_file(cmake/version.h.in ${PROJECT_BINARY_DIR}/version.h.in @ONLY)
add_custom_target(kapitza_version
  COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D INPUT=${PROJECT_BINARY_DIR}/version.h.in
          -D OUTPUT=${PROJECT_BINARY_DIR}/include/kapitza/version.h -P ${CMAKE_CURRENT_LIST_FILE}
  BYPRODUCTS ${PROJECT_BINARY_DIR}/include/kapitza/version.h
  VERBATIM)
