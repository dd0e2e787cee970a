#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include "tests/source_dir.h"

const char* const heddle::test::source_dir = HEDDLE_SOURCE_DIR;
