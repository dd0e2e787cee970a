heddle_test(run SOURCES run_test.cpp effects_test.cpp calibrate_test.cpp solid_test.cpp units_run_test.cpp weaves_test.cpp
            LIBRARIES heddle::run nlohmann_json::nlohmann_json)
heddle_test(heat SOURCES heat_test.cpp LIBRARIES heddle::run nlohmann_json::nlohmann_json)
heddle_test(study SOURCES study_test.cpp stamping_study_test.cpp indicator_outputs_test.cpp LIBRARIES heddle::run)
heddle_test(discover_report SOURCES discover_report_test.cpp LIBRARIES heddle::run)
# Runs that are killed, stopped, reused and listed; some through the built program.
heddle_test(resume SOURCES cache_test.cpp friction_store_test.cpp resume_test.cpp case_list_test.cpp LIBRARIES heddle::run)
target_compile_definitions(test_resume PRIVATE HEDDLE_PROGRAM="$<TARGET_FILE:heddle>")
heddle_test(shear_tests SOURCES shear_tests_test.cpp LIBRARIES heddle::run)
foreach(program test_run test_heat test_resume test_study test_shear_tests)
  target_compile_definitions(${program} PRIVATE HEDDLE_TEST_CACHE="${CMAKE_CURRENT_BINARY_DIR}/cache")
endforeach()
add_dependencies(test_resume heddle)
heddle_test(discover_stamping SOURCES discover_stamping_test.cpp LIBRARIES heddle::run)
