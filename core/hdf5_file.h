#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// HDF5 files as bytes in memory, sealed: the first 512 bytes (the user block, which HDF5 passes over) hold
/// the SHA-256 of the rest, so a file that was cut short or changed is known before HDF5 reads it. Equal
/// contents give equal bytes: no times are kept. h5dump and h5py open the files as they are. One thread at a
/// time.
namespace heddle {

/// A file that is damaged or lacks what is asked for; says which.
class Hdf5Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// @param path   of a new data set, "/state/x"; groups on the way are made
  /// @param shape  row-major; its product is values.size(); empty: one dimension
  void write(const std::string& path, std::span<const double> values, std::vector<std::size_t> shape = {});
  void write(const std::string& path, std::span<const int> values, std::vector<std::size_t> shape = {});
  /// Fields of many numbers, cut into planes of the first dimension and packed by zlib.
  /// @param shape  row-major, no extent zero
  void write_packed(const std::string& path, std::span<const float> values, std::vector<std::size_t> shape);
  void write_packed(const std::string& path, std::span<const std::uint16_t> values,
                    std::vector<std::size_t> shape);
  void write(const std::string& path, double value) { write(path, std::span(&value, 1)); }
  void write(const std::string& path, int value) { write(path, std::span(&value, 1)); }
  /// UTF-8 text of any length.
  void write(const std::string& path, std::string_view text);
  void write(const std::string& path, const char* text) { write(path, std::string_view(text)); }

  /// The sealed file. The writer is used up by it.
  std::string finish();

 private:
  enum class Layout { whole, packed };
  template <class Number>
  void write_numbers(const std::string& path, std::span<const Number> values, std::vector<std::size_t> shape,
                     Layout layout = Layout::whole);
  std::int64_t file_;
};

class Hdf5Reader {
 public:
  /// @throws Hdf5Error  if the bytes are cut short, changed, or no sealed file
  explicit Hdf5Reader(std::string_view bytes);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  /// Each throws Hdf5Error, naming the path, if there is no such data set or it holds another type. Numbers
  /// of any width are read.
  std::vector<double> doubles(const std::string& path) const;
  std::vector<int> integers(const std::string& path) const;
  double number(const std::string& path) const;
  int integer(const std::string& path) const;
  std::string text(const std::string& path) const;
  bool has(const std::string& path) const;

 private:
  template <class Number>
  std::vector<Number> numbers(const std::string& path) const;
  std::int64_t file_;
};

}  // namespace heddle
