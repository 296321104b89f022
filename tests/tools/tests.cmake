# Libraries for LD_PRELOAD: a malloc that fails on purpose (tests/python/run/test_memory.py), a rank that ends late (test_faults.py), a file system
# without locks (test_warnings.py), a stop within a stage (conftest.py).
foreach(name failing_memory slow_end no_locks stop_at)
  add_library(${name} MODULE tools/${name}.c)
  target_compile_options(${name} PRIVATE ${KAPITZA_FLAGS_C} -Wno-pedantic -fno-builtin -fvisibility=default)
  target_link_libraries(${name} PRIVATE $<$<STREQUAL:${name},slow_end>:MPI::MPI_C> ${CMAKE_DL_LIBS})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE C PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
endforeach()
