# Debian's FindOpenVDB.cmake asks for Boost.Iostreams and brings a FindTBB of its own that clashes with TBB's package;
# the headers need Boost's, and Imath's half (without it a file that uses half does not link). find_package(TBB) first.
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OPENVDB_LIBRARY openvdb)
find_path(IMATH_INCLUDE_DIR half.h PATH_SUFFIXES Imath)
find_library(IMATH_LIBRARY NAMES Imath Imath-3_1)
if(NOT OPENVDB_INCLUDE_DIR OR NOT OPENVDB_LIBRARY OR NOT IMATH_INCLUDE_DIR OR NOT IMATH_LIBRARY)
  message(FATAL_ERROR "OpenVDB not found. Install libopenvdb-dev, libimath-dev and libboost-dev.")
endif()
add_library(heddle_openvdb INTERFACE)
target_include_directories(heddle_openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE_DIR} ${IMATH_INCLUDE_DIR})
target_compile_definitions(heddle_openvdb INTERFACE OPENVDB_ABI_VERSION_NUMBER=10)
target_link_libraries(heddle_openvdb INTERFACE ${OPENVDB_LIBRARY} ${IMATH_LIBRARY} TBB::tbb)
