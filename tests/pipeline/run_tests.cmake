heddle_test(run SOURCES run_test.cpp LIBRARIES heddle::run)
