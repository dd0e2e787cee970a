#include "pipeline/stamping_record.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

constexpr const char* start_again = "Run it again without --resume, which starts from the beginning.";

std::string frame_group(std::size_t k) {
  return fmt::format("/frames/{:06d}", k);
}

/// The way out fits what changed: inputs can be given back, another program cannot.
std::string way_back(const std::vector<std::string>& changes) {
  const bool program = std::any_of(changes.begin(), changes.end(), [](const std::string& c) {
    return c.starts_with("sources.") || c.starts_with("machine.");
  });
  return program ? start_again
                 : fmt::format("Give it back its inputs, or choose another folder. {}", start_again);
}

}  // namespace

std::string bytes_of(const StampingRecord& record) {
  Hdf5Writer file;
  file.write("/key", record.key);
  file.write("/kind", "macroscale");
  file.write("/inputs", record.inputs);
  file.write("/steps", record.steps);
  macroscale::write(file, "/stamping", record.at);
  file.write("/frames/count", static_cast<int>(record.frames.size()));
  for (std::size_t k = 0; k < record.frames.size(); ++k) {
    file.write(frame_group(k) + "/step", record.frames[k].step);
    macroscale::write_instant(file, frame_group(k), record.frames[k].blank);
  }
  return file.finish();
}

StampingRecord read_stamping_record(const Hdf5Reader& file) {
  if (file.text("/kind") != "macroscale") throw Hdf5Error("is no stamping");
  StampingRecord record;
  record.key = file.text("/key");
  record.inputs = file.text("/inputs");
  record.steps = file.integer("/steps");
  record.at = macroscale::read_checkpoint(file, "/stamping");
  record.frames.resize(static_cast<std::size_t>(file.integer("/frames/count")));
  for (std::size_t k = 0; k < record.frames.size(); ++k) {
    record.frames[k].step = file.integer(frame_group(k) + "/step");
    record.frames[k].blank = macroscale::read_instant(file, frame_group(k), record.at.blank);
  }
  return record;
}

std::optional<StampingRecord> checkpoint_in(const std::filesystem::path& folder, const StageInputs& inputs) {
  const std::filesystem::path path = folder / checkpoint_name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  StampingRecord record;
  try {
    const std::string bytes = read_file(path);
    record = read_stamping_record(Hdf5Reader(bytes));
  } catch (const Hdf5Error& error) {
    throw InputError({{"run.resume.damaged"_rule, "--resume", path.string(), error.what(), start_again}});
  }
  const std::vector<std::string> changes = differences(record.inputs, inputs.text());
  if (!changes.empty())
    throw InputError(
        {{"run.resume.changed"_rule, "--resume", folder.string(),
          fmt::format("was run with other inputs: {}", fmt::join(changes, "; ")), way_back(changes)}});
  return record;
}

}  // namespace heddle::pipeline
