# Writes OUTPUT, a C++ file with one SHA-256 a group of sources, and leaves it alone where nothing changed, so that
# touching a source or editing a comment of another room compiles nothing.
#   cmake -DROOT=... -DOUTPUT=... -DBUILD="compiler and flags" -P hash_sources.cmake
# Files are listed when this runs, not when the build was configured: a header that is new counts at once.
cmake_minimum_required(VERSION 3.25)
set(stage_files case.h case.cpp case_rules.h case_rules.cpp case_settings.h case_settings.cpp stages.h stages.cpp friction_keys.h friction_keys.cpp solid_keys.h
    solid_keys.cpp solid_stage.h solid_stage.cpp solid_store.h solid_store.cpp friction_store.h
    friction_store.cpp friction_rig_stage.h friction_rig_stage.cpp stage_store.h stage_store.cpp stamping_record.h thermal_keys.h thermal_keys.cpp
    stamping_record.cpp)

function(hash_of result)
  set(text "")
  foreach(file ${ARGN})
    file(SHA256 ${ROOT}/${file} digest)
    string(APPEND text "${file} ${digest}\n")
  endforeach()
  string(SHA256 digest "${text}")
  set(${result} ${digest} PARENT_SCOPE)
endfunction()

set(lines "")
foreach(room core friction mesoscale macroscale)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${room}/*.h ${ROOT}/${room}/*.cpp)
  list(SORT files)
  hash_of(digest ${files})
  string(APPEND lines "    {\"${room}\", \"${digest}\"},\n")
endforeach()
list(TRANSFORM stage_files PREPEND pipeline/)
hash_of(digest ${stage_files})
string(APPEND lines "    {\"stages\", \"${digest}\"},\n")

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
"// Written by cmake/hash_sources.cmake.
#include \"pipeline/stage_keys.h\"

namespace heddle::pipeline {

const std::vector<std::pair<std::string, std::string>>& source_hashes() {
  static const std::vector<std::pair<std::string, std::string>> hashes{
@lines@    {\"build\", \"@BUILD@\"}};
  return hashes;
}

}  // namespace heddle::pipeline
")
