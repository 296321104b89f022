# A malloc that fails on purpose, for tests/python/test_memory.py.
add_library(failing_memory MODULE tools/failing_memory.c)
target_compile_options(failing_memory PRIVATE ${KAPITZA_FLAGS_C} -fno-builtin)
target_link_libraries(failing_memory PRIVATE ${CMAKE_DL_LIBS})
set_target_properties(failing_memory PROPERTIES LINKER_LANGUAGE C PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)

# A rank that ends late, for tests/python/test_faults.py.
add_library(slow_end MODULE tools/slow_end.c)
target_compile_options(slow_end PRIVATE ${KAPITZA_FLAGS_C})
target_link_libraries(slow_end PRIVATE MPI::MPI_C)
set_target_properties(slow_end PROPERTIES LINKER_LANGUAGE C PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)

# A load that sleeps, to measure how long ranks are idle (no test: what it tells depends on the machine).
add_executable(uneven tools/uneven.c)
target_compile_options(uneven PRIVATE ${KAPITZA_FLAGS_C} ${KAPITZA_SANITIZERS})
target_link_libraries(uneven PRIVATE kapitza_parallel)
set_target_properties(uneven PROPERTIES LINKER_LANGUAGE C RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)

# A file system without locks, for tests/python/test_advice.py.
add_library(no_locks MODULE tools/no_locks.c)
target_compile_options(no_locks PRIVATE ${KAPITZA_FLAGS_C} -Wno-pedantic)
target_link_libraries(no_locks PRIVATE ${CMAKE_DL_LIBS})
set_target_properties(no_locks PROPERTIES LINKER_LANGUAGE C PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)

# A stop within each stage, for tests/python/test_atlas_stops.py.
add_library(stop_at MODULE tools/stop_at.c)
target_compile_options(stop_at PRIVATE ${KAPITZA_FLAGS_C} -Wno-pedantic)
target_link_libraries(stop_at PRIVATE ${CMAKE_DL_LIBS})
set_target_properties(stop_at PROPERTIES LINKER_LANGUAGE C PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
