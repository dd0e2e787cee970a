#pragma once

#include <filesystem>

#include "core/curve.h"

namespace heddle::macroscale {

/// How a punch was seen to move: columns `time_s` and `punch_displacement_mm`, from 0 s and 0 mm on, both
/// rising from row to row. Between the rows a smooth curve that rises as they do (core/curve.h).
/// @return travel [m] over time [s]
/// @throws InputError  with every fault of the table and its line (rules process.punch.file.*)
Curve read_punch_table(const std::filesystem::path& path);

}  // namespace heddle::macroscale
