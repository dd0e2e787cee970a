# Configuration: schema, strict YAML reader, typed case, command line. yaml-cpp and CLI11 stay in one .cpp each.
add_library(heddle_config
  config_tree.cpp config_schema.cpp friction_keys.cpp solid_keys.cpp stamping_keys.cpp stamping_study_keys.cpp study_keys.cpp thermal_keys.cpp calibrate_keys.cpp discover_keys.cpp forming_effect_keys.cpp config_reader.cpp settings.cpp value_reader.cpp
  config_reference.cpp fabric_override.cpp case.cpp case_rules.cpp case_settings.cpp check_file.cpp command_line.cpp)
add_library(heddle::config ALIAS heddle_config)
target_compile_definitions(heddle_config PRIVATE HEDDLE_VERSION="${PROJECT_VERSION}")
target_link_libraries(heddle_config
  PUBLIC heddle::core heddle::friction heddle::mesoscale heddle::solid heddle::cell_study heddle::macroscale
  PRIVATE heddle::output heddle::tool_files yaml-cpp CLI11::CLI11 heddle_warnings)
