#include "core/hdf5_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <functional>
#include <numeric>
#include <type_traits>
#include <utility>

#include "core/sha256.h"

namespace heddle {

namespace {

constexpr std::size_t seal_size = 512;  // smallest user block HDF5 knows
constexpr std::string_view mark = "heddle data, HDF5 from byte 512 on\nsha256 ";

std::string seal_of(std::string_view image) {
  std::string seal = std::string(mark) + sha256(image) + "\n";
  seal.resize(seal_size, '\n');
  return seal;
}

/// An HDF5 identifier that closes itself.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw Hdf5Error(what);
  }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void demand(bool holds, const std::string& what) {
  if (!holds) throw Hdf5Error(what);
}

template <class Number>
hid_t memory_type() {
  if constexpr (std::is_same_v<Number, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<Number, int>) return H5T_NATIVE_INT;
  if constexpr (std::is_same_v<Number, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<Number, std::uint16_t>) return H5T_NATIVE_UINT16;
  if constexpr (std::is_same_v<Number, char>) return H5T_NATIVE_CHAR;
}

/// The same bytes on every machine.
template <class Number>
hid_t file_type() {
  if constexpr (std::is_same_v<Number, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<Number, int>) return H5T_STD_I32LE;
  if constexpr (std::is_same_v<Number, float>) return H5T_IEEE_F32LE;
  if constexpr (std::is_same_v<Number, std::uint16_t>) return H5T_STD_U16LE;
  if constexpr (std::is_same_v<Number, char>) return H5T_STD_I8LE;
}

template <class Number>
H5T_class_t type_class() {
  return std::is_same_v<Number, double> ? H5T_FLOAT : H5T_INTEGER;
}

/// How files are opened: in memory alone.
struct InMemory {
  Id access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "HDF5 gave no file access list"};
  InMemory() {
    constexpr std::size_t growth = 1 << 20;
    demand(H5Pset_fapl_core(access, growth, false) >= 0, "HDF5 cannot keep a file in memory");
  }
};

void write_data_set(hid_t file, const std::string& path, hid_t file_type, hid_t memory_type,
                    const void* values, std::vector<hsize_t> shape, bool packed = false) {
  const std::string what = fmt::format("data set {} cannot be written", path);
  // An extent of zero needs no storage and HDF5 takes it as it is.
  const Id space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, what);
  const Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, what);
  const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  demand(H5Pset_create_intermediate_group(links, 1) >= 0, what);
  demand(H5Pset_obj_track_times(creation, false) >= 0, what);
  if (packed) {
    std::vector<hsize_t> plane = shape;
    plane.front() = 1;
    // Level 1: the next levels cost several times as long for a few per cent of size.
    demand(H5Pset_chunk(creation, static_cast<int>(plane.size()), plane.data()) >= 0 &&
               H5Pset_shuffle(creation) >= 0 && H5Pset_deflate(creation, 1) >= 0,
           what);
  }
  const Id data(H5Dcreate2(file, path.c_str(), file_type, space, links, creation, H5P_DEFAULT), H5Dclose,
                what);
  demand(H5Dwrite(data, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, what);
}

}  // namespace

Hdf5Writer::Hdf5Writer() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors come as exceptions, not on standard error
  const InMemory memory;
  const Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "HDF5 gave no file creation list");
  demand(H5Pset_obj_track_times(creation, false) >= 0, "HDF5 cannot leave times out");
  // The name is never opened: the file lives in memory.
  file_ = H5Fcreate("in memory", H5F_ACC_TRUNC, creation, memory.access);
  demand(file_ >= 0, "HDF5 cannot begin a file in memory");
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ >= 0) H5Fclose(file_);
}

template <class Number>
void Hdf5Writer::write_numbers(const std::string& path, std::span<const Number> values,
                               std::vector<std::size_t> shape, Layout layout) {
  if (shape.empty()) shape = {values.size()};
  const std::size_t expected =
      std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  if (expected != values.size())
    throw std::logic_error(fmt::format("{}: {} values for a shape of {}", path, values.size(), expected));
  write_data_set(file_, path, file_type<Number>(), memory_type<Number>(), values.data(),
                 {shape.begin(), shape.end()}, layout == Layout::packed);
}

void Hdf5Writer::write(const std::string& path, std::span<const double> values,
                       std::vector<std::size_t> shape) {
  write_numbers(path, values, std::move(shape));
}
void Hdf5Writer::write(const std::string& path, std::span<const int> values, std::vector<std::size_t> shape) {
  write_numbers(path, values, std::move(shape));
}
void Hdf5Writer::write_packed(const std::string& path, std::span<const float> values,
                              std::vector<std::size_t> shape) {
  write_numbers(path, values, std::move(shape), Layout::packed);
}
void Hdf5Writer::write_packed(const std::string& path, std::span<const std::uint16_t> values,
                              std::vector<std::size_t> shape) {
  write_numbers(path, values, std::move(shape), Layout::packed);
}

void Hdf5Writer::write(const std::string& path, std::string_view text) {
  const std::string what = fmt::format("data set {} cannot be written", path);
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose, what);
  // HDF5 knows no text of length zero: the end mark is stored with it.
  demand(H5Tset_size(type, text.size() + 1) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0, what);
  write_data_set(file_, path, type, type, std::string(text).c_str(), {1});
}

std::string Hdf5Writer::finish() {
  demand(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0, "the file cannot be completed");
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  demand(size >= 0, "the file cannot be completed");
  std::string image(static_cast<std::size_t>(size), '\0');
  demand(H5Fget_file_image(file_, image.data(), image.size()) == size, "the file cannot be completed");
  H5Fclose(std::exchange(file_, -1));
  return seal_of(image) + image;
}

Hdf5Reader::Hdf5Reader(std::string_view bytes) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  demand(bytes.starts_with(mark), "is not a sealed HDF5 file of heddle");
  demand(bytes.size() > seal_size, "is cut short");
  const std::string_view image = bytes.substr(seal_size);
  demand(bytes.substr(0, seal_size) == seal_of(image), "is damaged: its contents do not match their hash");
  const InMemory memory;
  // HDF5 copies the image.
  demand(H5Pset_file_image(memory.access, const_cast<char*>(image.data()), image.size()) >= 0,
         "cannot be read into memory");
  file_ = H5Fopen("in memory", H5F_ACC_RDONLY, memory.access);
  demand(file_ >= 0, "is no HDF5 file");
}

Hdf5Reader::~Hdf5Reader() {
  H5Fclose(file_);
}

bool Hdf5Reader::has(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (H5Lexists(file_, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

template <class Number>
std::vector<Number> Hdf5Reader::numbers(const std::string& path) const {
  const std::string what = fmt::format("lacks {}", path);
  demand(has(path), what);
  const Id data(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Id type(H5Dget_type(data), H5Tclose, what);
  demand(H5Tget_class(type) == type_class<Number>(), fmt::format("{} holds another type of value", path));
  const Id space(H5Dget_space(data), H5Sclose, what);
  std::vector<Number> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  demand(H5Dread(data, memory_type<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, what);
  return values;
}

std::vector<double> Hdf5Reader::doubles(const std::string& path) const {
  return numbers<double>(path);
}
std::vector<int> Hdf5Reader::integers(const std::string& path) const {
  return numbers<int>(path);
}

double Hdf5Reader::number(const std::string& path) const {
  const auto values = doubles(path);
  demand(values.size() == 1, fmt::format("{} is no single number", path));
  return values[0];
}

int Hdf5Reader::integer(const std::string& path) const {
  const auto values = integers(path);
  demand(values.size() == 1, fmt::format("{} is no single number", path));
  return values[0];
}

std::string Hdf5Reader::text(const std::string& path) const {
  const std::string what = fmt::format("lacks {}", path);
  demand(has(path), what);
  const Id data(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Id type(H5Dget_type(data), H5Tclose, what);
  demand(H5Tget_class(type) == H5T_STRING, fmt::format("{} holds another type of value", path));
  std::string text(H5Tget_size(type), '\0');
  demand(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0, what);
  text.pop_back();
  return text;
}

}  // namespace heddle
