# HDF5's C interface, serial build, as one target.
find_package(HDF5 REQUIRED COMPONENTS C)
add_library(heddle_hdf5 INTERFACE)
target_include_directories(heddle_hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
target_link_libraries(heddle_hdf5 INTERFACE ${HDF5_C_LIBRARIES})
