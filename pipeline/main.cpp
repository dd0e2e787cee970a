#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "core/problem.h"
#include "pipeline/command_line.h"
#include "pipeline/commands.h"
#include "pipeline/study_command.h"

int main(int argument_count, char** arguments) {
  using namespace heddle;
  try {
    const std::vector<std::string> words(arguments + 1, arguments + argument_count);
    return pipeline::dispatch(words, {.run = pipeline::run_case,
                                      .weave = pipeline::weave_case,
                                      .friction = pipeline::friction_case,
                                      .check = pipeline::check_file,
                                      .calibrate = pipeline::calibrate_case,
                                      .discover = pipeline::discover_case,
                                      .export_law = pipeline::export_case,
                                      .study = pipeline::study_case});
  } catch (const InputError& error) {
    std::cerr << error.what();
    return pipeline::exit_bad_input;
  } catch (const std::exception& error) {
    std::cerr << "heddle: " << error.what() << '\n';
    return pipeline::exit_failed;
  }
}
