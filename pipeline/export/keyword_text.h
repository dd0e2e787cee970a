#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/export/part_model.h"

/// Lines of the keyword language that Abaqus and CalculiX share.
namespace heddle::pipeline {

double celsius(const PartTemperature& temperature);

/// Numbers, eight a line.
std::string data_lines(const std::vector<double>& values);
/// A set's members, sorted and each once, sixteen a line below its keyword.
std::string set_lines(const std::string& keyword, std::vector<int> members);
/// *ORIENTATION with its 1 along the warp of a cell and 3 along the normal.
std::string orientation_lines(const std::string& name, const CellStiffness& cell);
/// The set SUPPORTS and what holds it.
/// @param number  of a node of the middle surface in the file
std::string support_lines(const PartModel& model, const std::function<int(int)>& number);

}  // namespace heddle::pipeline
