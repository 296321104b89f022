# What `cmake --install` puts where (GNUInstallDirs). The manual page and the completions are printed by the program, when it is
# installed: a build for another machine's instruction set must not need a CPU that has it.
include(GNUInstallDirs)
if(SKBUILD) # a wheel: what pip puts into bin and share of the environment (pyproject.toml)
  set(CMAKE_INSTALL_BINDIR ${SKBUILD_SCRIPTS_DIR})
  set(CMAKE_INSTALL_DATADIR ${SKBUILD_DATA_DIR}/share)
  set(CMAKE_INSTALL_MANDIR ${SKBUILD_DATA_DIR}/share/man)
  set(CMAKE_INSTALL_DOCDIR ${SKBUILD_DATA_DIR}/share/doc/kapitza)
endif()

# kapitza_printed(file FOLDER folder WORDS words...): what `kapitza words...` prints becomes the file in that folder.
function(kapitza_printed file)
  cmake_parse_arguments(arg "" "FOLDER" "WORDS" ${ARGN})
  set(path ${PROJECT_BINARY_DIR}/printed/${file})
  install(CODE "
    file(MAKE_DIRECTORY \"${PROJECT_BINARY_DIR}/printed\")
    execute_process(COMMAND \"$<TARGET_FILE:kapitza>\" ${arg_WORDS} OUTPUT_FILE \"${path}\" RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
      file(REMOVE \"${path}\")
      message(WARNING \"${file} is left out: the program does not run here\")
    endif()")
  install(FILES ${path} DESTINATION ${arg_FOLDER} OPTIONAL)
endfunction()

# Libraries that stand beside the compiler's own (conda, MPI of PyPI) are found where they were when it was built.
set_target_properties(kapitza PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS kapitza RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The library, with its header; of a wheel beside the package, which loads it.
if(TARGET kapitza_shared AND SKBUILD)
  install(TARGETS kapitza_shared LIBRARY DESTINATION kapitza FILE_SET HEADERS DESTINATION kapitza)
elseif(TARGET kapitza_shared)
  include(CMakePackageConfigHelpers)
  set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/kapitza)
  configure_file(cmake/kapitza.pc.in kapitza.pc @ONLY)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/kapitzaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(TARGETS kapitza_shared EXPORT kapitza COMPONENT library LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
  install(EXPORT kapitza NAMESPACE kapitza:: FILE kapitzaConfig.cmake DESTINATION ${folder} COMPONENT library)
  install(FILES ${PROJECT_BINARY_DIR}/kapitzaConfigVersion.cmake DESTINATION ${folder} COMPONENT library)
  install(FILES ${PROJECT_BINARY_DIR}/kapitza.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
endif()
kapitza_printed(kapitza.1 FOLDER ${CMAKE_INSTALL_MANDIR}/man1 WORDS --manual)
kapitza_printed(kapitza FOLDER ${CMAKE_INSTALL_DATADIR}/bash-completion/completions WORDS --completion bash)
kapitza_printed(_kapitza FOLDER ${CMAKE_INSTALL_DATADIR}/zsh/site-functions WORDS --completion zsh)
kapitza_printed(kapitza.fish FOLDER ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d WORDS --completion fish)

install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/kapitza FILES_MATCHING PATTERN "*.yaml")
install(PROGRAMS scripts/kapitza.sbatch scripts/kapitza.pbs DESTINATION ${CMAKE_INSTALL_DATADIR}/kapitza)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
