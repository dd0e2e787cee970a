# Writes OUTPUT, a C++ file that holds the text of every file of configs/effects.
#   cmake -DROOT=... -DOUTPUT=... -P embed_effects.cmake
cmake_minimum_required(VERSION 3.25)
file(GLOB files RELATIVE ${ROOT}/configs/effects ${ROOT}/configs/effects/*.yaml)
list(SORT files)
set(entries "")
foreach(name ${files})
  file(READ ${ROOT}/configs/effects/${name} text)
  string(APPEND entries "      {\"${name}\", R\"yaml(${text})yaml\"},\n")
endforeach()
set(code "#include \"pipeline/discover/effect_library.h\"

namespace heddle::discover {

const std::vector<std::pair<std::string, std::string>>& built_in_effect_texts() {
  static const std::vector<std::pair<std::string, std::string>> texts{
${entries}  };
  return texts;
}

}  // namespace heddle::discover
")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${code}" @ONLY)
