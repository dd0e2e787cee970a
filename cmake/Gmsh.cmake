# Debian's gmsh ships no CMake package.
find_path(GMSH_INCLUDE_DIR gmsh.h)
find_library(GMSH_LIBRARY gmsh)
if(NOT GMSH_INCLUDE_DIR OR NOT GMSH_LIBRARY)
  message(FATAL_ERROR "gmsh not found. Install libgmsh-dev.")
endif()
add_library(heddle_gmsh INTERFACE)
target_include_directories(heddle_gmsh SYSTEM INTERFACE ${GMSH_INCLUDE_DIR})
target_link_libraries(heddle_gmsh INTERFACE ${GMSH_LIBRARY})
