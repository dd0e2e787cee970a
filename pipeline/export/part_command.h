#pragma once

#include <filesystem>

#include "pipeline/case.h"
#include "pipeline/commands.h"

namespace heddle::pipeline {

/// Writes the formed part of a stamping's folder: part_TARGET.inp, part_stiffness.csv (a row a cell, for any
/// code) and part.vtu.
/// @param options  target "ccx" or "abaqus"
/// @param to       folder of the files
/// @return  an exit code
/// @throws InputError  as read_formed_part; export.temperature
int export_part(const ExportOptions& options, const Case& a_case, const std::filesystem::path& to);

}  // namespace heddle::pipeline
