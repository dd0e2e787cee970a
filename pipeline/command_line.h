#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/commands.h"

namespace heddle::pipeline {

/// The functions behind the subcommands; replaced in tests.
struct Commands {
  std::function<int(const RunOptions&)> run, weave, friction;
  std::function<int(const CheckOptions&)> check;
  std::function<int(const CalibrateOptions&)> calibrate;
  std::function<int(const DiscoverOptions&)> discover = {};
  std::function<int(const ExportOptions&)> export_law;
  std::function<int(const RunOptions&)> study = {};
};

/// Reads the command line and calls the function it asks for.
/// Help and version go to standard output, a faulty command line to standard error.
/// @param arguments  without the program's name
/// @return exit code: of the command, 0 for help and version, 2 for a faulty command line
/// Exceptions of the command pass through.
int dispatch(const std::vector<std::string>& arguments, const Commands& commands);

}  // namespace heddle::pipeline
