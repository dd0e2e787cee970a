#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/problem.h"

namespace heddle::macroscale {

/// Size of a file that can be read [bytes].
/// @throws InputError under KEY.file when it is missing, a folder, not readable or empty
std::uintmax_t require_file(const std::filesystem::path& file, const std::string& key);

/// "mm" for 1e-3, "inch" for 0.0254; "0.5 m" for what has no name.
std::string unit_name(double metres);

/// Checks that a STEP file (ISO 10303-21) is whole and that the length unit it states is `length_unit` [m].
///
/// OpenCASCADE converts every file to millimetres, so a wrong `length_unit` would go unnoticed there. The
/// unit stated is that of GLOBAL_UNIT_ASSIGNED_CONTEXT: an SI_UNIT with its prefix, or a
/// CONVERSION_BASED_UNIT.
/// @throws InputError: not a STEP file, cut off, larger than 64 MB, without a length unit, two units, another
/// unit
void require_step(const std::filesystem::path& file, double length_unit, const std::string& key);

}  // namespace heddle::macroscale
