#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/hdf5_file.h"

using heddle::Hdf5Error;
using heddle::Hdf5Reader;
using heddle::Hdf5Writer;

namespace {

const std::vector<double> numbers{1.0 / 3.0, -0.0, 5e-324, std::numeric_limits<double>::max(), std::nan("")};

std::string sample() {
  Hdf5Writer file;
  file.write("/state/x", numbers);
  file.write("/state/table", std::vector<double>{1, 2, 3, 4, 5, 6}, {2, 3});
  file.write("/state/none", std::vector<double>{});
  file.write("/state/quads", std::vector<int>{-1, 2147483647}, {1, 2});
  file.write("/step", 12);
  file.write("/time", 0.25);
  file.write("/name", "a text of 3 \xC2\xB5m\nwith two lines");
  file.write("/empty", "");
  return file.finish();
}

}  // namespace

TEST_CASE("what goes into an HDF5 file comes back bit for bit, and equal contents are equal bytes",
          "[core][hdf5]") {
  const std::string bytes = sample();
  CHECK(bytes == sample());
  const Hdf5Reader file(bytes);
  const std::vector<double> x = file.doubles("/state/x");
  REQUIRE(x.size() == numbers.size());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(std::signbit(x[i]) == std::signbit(numbers[i]));
  for (std::size_t i = 0; i + 1 < x.size(); ++i) CHECK(x[i] == numbers[i]);
  CHECK(std::isnan(x.back()));
  CHECK(file.doubles("/state/table") == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(file.doubles("/state/none").empty());
  CHECK(file.integers("/state/quads") == std::vector<int>{-1, 2147483647});
  CHECK(file.integer("/step") == 12);
  CHECK(file.number("/time") == 0.25);
  CHECK(file.text("/name") == "a text of 3 \xC2\xB5m\nwith two lines");
  CHECK(file.text("/empty").empty());
  CHECK(file.has("/state/x"));
  CHECK_FALSE(file.has("/state/y"));
  CHECK_FALSE(file.has("/other/x"));
}

TEST_CASE("an HDF5 file that is cut short, changed or foreign is refused before it is read",
          "[core][hdf5][wrong input]") {
  const std::string bytes = sample();
  CHECK_THROWS_WITH(Hdf5Reader(bytes.substr(0, bytes.size() - 1)),
                    Catch::Contains("do not match their hash"));
  CHECK_THROWS_WITH(Hdf5Reader(bytes.substr(0, 300)), Catch::Contains("cut short"));
  CHECK_THROWS_WITH(Hdf5Reader(std::string("not ours")), Catch::Contains("not a sealed HDF5 file"));
  CHECK_THROWS_WITH(Hdf5Reader(std::string()), Catch::Contains("not a sealed HDF5 file"));
  for (std::size_t at : {std::size_t{60}, std::size_t{600}, bytes.size() - 1}) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    CHECK_THROWS_AS(Hdf5Reader(changed), Hdf5Error);
  }
}

TEST_CASE("asking an HDF5 file for what it does not hold names the path", "[core][hdf5][wrong input]") {
  const std::string bytes = sample();
  const Hdf5Reader file(bytes);
  CHECK_THROWS_WITH(file.doubles("/state/y"), Catch::Contains("lacks /state/y"));
  CHECK_THROWS_WITH(file.doubles("/step"), Catch::Contains("another type"));
  CHECK_THROWS_WITH(file.text("/step"), Catch::Contains("another type"));
  CHECK_THROWS_WITH(file.number("/state/x"), Catch::Contains("no single number"));
}
