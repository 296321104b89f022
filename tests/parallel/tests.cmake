foreach(ranks 1 3)
  kapitza_test(stage LABEL parallel LAYER parallel RANKS ${ranks} SECONDS 60)
  kapitza_test(checkpoint LABEL parallel LAYER parallel RANKS ${ranks} SECONDS 60)
  kapitza_test(local_records LABEL parallel LAYER parallel RANKS ${ranks} SECONDS 60)
  kapitza_test(stop LABEL parallel LAYER parallel RANKS ${ranks} SECONDS 60)
endforeach()
kapitza_test(schedule LABEL parallel LAYER parallel)
target_include_directories(test_parallel_schedule PRIVATE ${PROJECT_SOURCE_DIR}/src/parallel)
kapitza_test(file_lock LABEL parallel LAYER parallel SECONDS 60 COST 20)
kapitza_test(file_lock LABEL parallel LAYER parallel RANKS 2 SECONDS 60)
kapitza_test(stage LABEL parallel LAYER parallel SECONDS 60) # and without mpirun
kapitza_test(stage LABEL parallel LAYER parallel RANKS 5 SECONDS 60) # more ranks than cores
kapitza_test(progress LABEL parallel LAYER parallel SECONDS 60 COST 9)

# A small program that is killed at random moments and resumed.
add_executable(worker parallel/worker.c)
target_compile_options(worker PRIVATE ${KAPITZA_FLAGS_C} ${KAPITZA_SANITIZERS})
target_link_libraries(worker PRIVATE kapitza_parallel)
set_target_properties(worker PROPERTIES LINKER_LANGUAGE C RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME parallel.kills COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tools/kill_loop.sh ${Python3_EXECUTABLE} $<TARGET_FILE:worker>)
cmake_path(GET MPIRUN PARENT_PATH launchers)
set_tests_properties(parallel.kills PROPERTIES LABELS parallel TIMEOUT 240 COST 10 RESOURCE_LOCK mpirun PROCESSORS 2
                     ENVIRONMENT_MODIFICATION PATH=path_list_prepend:${launchers})
