# One static library per folder of src/: a layer is a folder, so its sources are those that are there (no list to keep beside it).

# kapitza_layer(name LAYERS lower... LIBRARIES targets...): src/name becomes the library kapitza_name.
function(kapitza_layer name)
  cmake_parse_arguments(arg "" "" "LAYERS;LIBRARIES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS src/${name}/*.c src/${name}/*.f90)
  list(FILTER sources EXCLUDE REGEX "/(main|entry)\\.c$")
  foreach(folder ${KAPITZA_LEFT_OUT})
    list(FILTER sources EXCLUDE REGEX "/src/${folder}/")
  endforeach()
  if(NOT sources) # a power that is left out
    return()
  endif()
  add_library(kapitza_${name} STATIC ${sources})
  target_include_directories(kapitza_${name} PUBLIC include ${PROJECT_BINARY_DIR}/include PRIVATE src/${name})
  set_target_properties(kapitza_${name} PROPERTIES Fortran_MODULE_DIRECTORY ${PROJECT_BINARY_DIR}/modules
                                                   LINKER_LANGUAGE C)
  target_include_directories(kapitza_${name} PRIVATE ${PROJECT_BINARY_DIR}/modules)
  target_compile_options(kapitza_${name} PRIVATE
    -march=${KAPITZA_ARCH} ${KAPITZA_SANITIZERS}
    $<$<COMPILE_LANGUAGE:C>:${KAPITZA_FLAGS_C}>
    $<$<COMPILE_LANGUAGE:Fortran>:${KAPITZA_FLAGS_FORTRAN}>)
  # Kernel and dynamics compute; of other layers compiling takes longer than running. Without optimization gcc does not know the ranges of
  # values, and warns of what cannot be; the build of CI with optimization tells it.
  if(CMAKE_BUILD_TYPE STREQUAL Debug AND NOT name MATCHES "kernel|dynamics")
    target_compile_options(kapitza_${name} PRIVATE $<$<COMPILE_LANGUAGE:C>:-O0;-Wno-maybe-uninitialized;-Wno-format-truncation>)
  endif()
  foreach(layer ${arg_LAYERS})
    if(layer STREQUAL parallel) # the library has that without MPI in its place
      target_link_libraries(kapitza_${name} PUBLIC $<IF:$<BOOL:$<TARGET_PROPERTY:KAPITZA_ALONE>>,kapitza_alone,kapitza_parallel>)
    else()
      target_link_libraries(kapitza_${name} PUBLIC kapitza_${layer})
    endif()
  endforeach()
  target_link_libraries(kapitza_${name} PUBLIC ${arg_LIBRARIES} m)
  kapitza_includes(${name})
endfunction()

# Fortran files with parts (*.inc) are compiled again when one of the layer's parts changes: ninja does not see these includes.
function(kapitza_includes name)
  file(GLOB_RECURSE parts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.inc)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS src/${name}/*.f90)
  foreach(source ${sources})
    file(STRINGS ${source} includes REGEX "^ *include '")
    if(includes)
      set_property(SOURCE ${source} APPEND PROPERTY OBJECT_DEPENDS "${parts}")
    endif()
    # What C neither calls nor hands memory to knows the bounds of its arrays, after which -fcheck looks: the sanitizers would take as
    # long again to compile.
    file(STRINGS ${source} for_c REGEX "bind\\(c" LIMIT_COUNT 1)
    if(KAPITZA_SANITIZE AND NOT for_c)
      set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS "-fno-sanitize=all")
    endif()
  endforeach()
endfunction()

# Program and library: only their entries (the instruction-set check) are compiled for the first instruction set of the processor.
set(KAPITZA_FIRST x86-64)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(KAPITZA_FIRST armv8-a)
endif()

# libkapitza.so: all layers, without MPI. It shows the names of include/kapitza.h alone.
function(kapitza_shared)
  get_target_property(sources kapitza_parallel SOURCES)
  get_target_property(options kapitza_parallel COMPILE_OPTIONS)
  add_library(kapitza_alone STATIC ${sources})
  target_include_directories(kapitza_alone PRIVATE src/parallel/alone src/parallel)
  target_compile_options(kapitza_alone PRIVATE ${options})
  target_link_libraries(kapitza_alone PUBLIC kapitza_common Threads::Threads)
  set(names ${PROJECT_SOURCE_DIR}/cmake/library_names.map)
  add_library(kapitza_shared SHARED src/library/entry.c)
  target_compile_options(kapitza_shared PRIVATE -march=${KAPITZA_FIRST} ${KAPITZA_FLAGS_C} ${KAPITZA_SANITIZERS})
  target_link_libraries(kapitza_shared PRIVATE $<LINK_LIBRARY:WHOLE_ARCHIVE,kapitza_library>)
  target_link_options(kapitza_shared PRIVATE LINKER:--as-needed,--no-undefined,--version-script=${names})
  target_sources(kapitza_shared PUBLIC FILE_SET HEADERS BASE_DIRS include FILES include/kapitza.h)
  set_target_properties(kapitza_shared PROPERTIES
    KAPITZA_ALONE ON LINKER_LANGUAGE C OUTPUT_NAME kapitza EXPORT_NAME kapitza LINK_DEPENDS ${names}
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR} INSTALL_RPATH_USE_LINK_PATH ON)
  if(NOT SKBUILD) # a wheel has no symbolic links
    set_target_properties(kapitza_shared PROPERTIES VERSION ${PROJECT_VERSION}
                                                    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  endif()
endfunction()

function(kapitza_program)
  add_executable(kapitza src/app/main.c)
  target_compile_options(kapitza PRIVATE -march=${KAPITZA_FIRST} ${KAPITZA_FLAGS_C} ${KAPITZA_SANITIZERS})
  target_link_options(kapitza PRIVATE LINKER:--as-needed) # HDF5 names libraries for parts that are not used
  target_link_libraries(kapitza PRIVATE kapitza_app)
  set_target_properties(kapitza PROPERTIES LINKER_LANGUAGE C)
endfunction()

# Code that gfortran makes does not look whether malloc gave memory: include/kapitza/common.h.
function(kapitza_check_memory)
  target_link_options(kapitza_common INTERFACE LINKER:--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=free)
endfunction()
