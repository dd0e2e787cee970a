heddle_test(config SOURCES config_bad_test.cpp config_reader_test.cpp command_line_test.cpp include_directions_test.cpp
            rule_list_test.cpp advice_keys_test.cpp
            LIBRARIES heddle::config)
