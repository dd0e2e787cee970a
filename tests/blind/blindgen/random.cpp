#include "random.h"

#include <cmath>

namespace blindgen {

namespace {

/// Finaliser of SplitMix64 (Steele, Lea & Flood 2014): every bit of the input moves half of the output.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

constexpr std::uint64_t golden = 0x9E3779B97F4A7C15ULL;

/// FNV-1a.
std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 0xCBF29CE484222325ULL;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return value;
}

}  // namespace

Stream::Stream(std::uint64_t seed, std::uint64_t number, std::string_view name)
    : key_(mix(mix(mix(seed + golden) + number + golden) ^ hash(name))) {}

std::uint64_t Stream::bits() {
  return mix(key_ + golden * ++counter_);
}

double Stream::uniform() {
  return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53;
}

double Stream::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

double Stream::log_uniform(double low, double high) {
  return low * std::pow(high / low, uniform());
}

double Stream::normal() {
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * 3.14159265358979323846 * uniform());
}

int Stream::index(int count) {
  return static_cast<int>(uniform() * count);
}

double Stream::sign() {
  return uniform() < 0.5 ? -1.0 : 1.0;
}

}  // namespace blindgen
