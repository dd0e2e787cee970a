# FFTW ships no CMake package that Debian installs.
find_path(FFTW_INCLUDE_DIR fftw3.h)
find_library(FFTW_LIBRARY fftw3)
if(NOT FFTW_INCLUDE_DIR OR NOT FFTW_LIBRARY)
  message(FATAL_ERROR "FFTW not found. Install libfftw3-dev.")
endif()
add_library(heddle_fftw INTERFACE)
target_include_directories(heddle_fftw SYSTEM INTERFACE ${FFTW_INCLUDE_DIR})
target_link_libraries(heddle_fftw INTERFACE ${FFTW_LIBRARY})
