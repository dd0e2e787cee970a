# SuiteSparse 5 ships no CMake package. CHOLMOD brings METIS; the BLAS behind it must be OpenBLAS
# (reference BLAS factors 4 to 8 times slower), which core/sparse_solver checks again at run time.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
find_library(OPENBLAS_LIBRARY openblas PATH_SUFFIXES openblas-pthread)
if(NOT CHOLMOD_INCLUDE_DIR OR NOT CHOLMOD_LIBRARY)
  message(FATAL_ERROR "CHOLMOD not found. Install libsuitesparse-dev.")
endif()
if(NOT OPENBLAS_LIBRARY)
  message(FATAL_ERROR "OpenBLAS not found. Install libopenblas-pthread-dev; the reference BLAS is too slow.")
endif()
find_library(GOMP_LIBRARY NAMES gomp libgomp.so.1)  # comes with CHOLMOD, which is built with OpenMP
add_library(heddle_cholmod INTERFACE)
target_include_directories(heddle_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
# OpenBLAS first: it then serves every BLAS symbol CHOLMOD asks for.
target_link_libraries(heddle_cholmod INTERFACE ${OPENBLAS_LIBRARY} ${CHOLMOD_LIBRARY} ${GOMP_LIBRARY})
