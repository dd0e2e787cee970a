# What a run leaves behind: tables, records, meshes and the report. No configuration, no solver.
add_library(heddle_output
  painter.cpp painter_style.cpp page.cpp json_text.cpp chart.cpp colour_bar.cpp picture.cpp mesh_picture.cpp
  report.cpp report_figures.cpp report_heat.cpp report_plies.cpp report_solid.cpp report_style.cpp report_verdicts.cpp rig_figures.cpp
  outputs.cpp outputs_json.cpp outputs_solid.cpp outputs_files.cpp coupon_report.cpp stack_report.cpp export_vtu.cpp part_stiffness.cpp voxel_export.cpp
  export/abaqus_part.cpp export/ccx_part.cpp export/keyword_text.cpp export/part_layers.cpp export/part_mesh.cpp export/part_model.cpp export/part_picture.cpp)
add_library(heddle::output ALIAS heddle_output)
target_link_libraries(heddle_output
  PUBLIC heddle::core heddle::friction heddle::mesoscale heddle::solid  # macroscale/stamping.h for its plain structs only
  PRIVATE nlohmann_json::nlohmann_json ZLIB::ZLIB heddle_warnings)
