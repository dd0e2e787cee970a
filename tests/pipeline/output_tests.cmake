# Files, pictures and the report, apart from configuration and solver.
heddle_test(output
  SOURCES painter_test.cpp report_test.cpp outputs_test.cpp vtu_test.cpp plies_outputs_test.cpp voxel_export_test.cpp
  LIBRARIES heddle::output nlohmann_json::nlohmann_json ZLIB::ZLIB)
# The formed part as a structural model, and what CalculiX makes of it.
heddle_test(part_export SOURCES part_export_test.cpp LIBRARIES heddle::output heddle::macroscale)
