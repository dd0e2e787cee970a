#pragma once

namespace heddle::test {

/// Top folder of the repository. Known to one file only (main.cpp), so that test programs of two clones
/// compile to the same bytes and a compiler cache serves both.
extern const char* const source_dir;

}  // namespace heddle::test
