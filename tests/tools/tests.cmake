# Judges of results, used by Python drivers and by the benchmark.
add_executable(truth_label tools/truth_label.c tools/catalogue.c)
target_compile_options(truth_label PRIVATE ${KAPITZA_FLAGS_C} ${KAPITZA_SANITIZERS})
target_link_libraries(truth_label PRIVATE kapitza_kernel)
set_target_properties(truth_label PROPERTIES LINKER_LANGUAGE C RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
