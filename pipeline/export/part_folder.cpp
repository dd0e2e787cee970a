#include "pipeline/export/part_folder.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "macroscale/whole_blank.h"
#include "mesoscale/cell.h"
#include "pipeline/outputs.h"
#include "pipeline/stamping_record.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

bool tables_shear(const Case& a_case) {
  if (!a_case.solid) return false;
  const std::vector<double>& angles = a_case.solid->shear_angles;
  return std::any_of(angles.begin(), angles.end(), [&](double angle) { return angle != angles.front(); });
}

std::string run_again(const fs::path& folder, const std::string& more) {
  return fmt::format("heddle run {}/resolved.yaml{} -o {}", folder.string(), more, folder.string());
}

Problem problem_of_stamping(const fs::path& folder, const std::string& rule, const std::string& way_out) {
  return {"export.part.stamping"_rule, "folder", folder.string(), rule, way_out};
}

std::optional<StampingRecord> record_in(const fs::path& folder, Problems& problems) {
  const fs::path file = folder / checkpoint_name;
  if (!fs::is_regular_file(file) || !fs::is_regular_file(folder / "manifest.json")) {
    problems.push_back(
        problem_of_stamping(folder, "holds no stamping that came to its end",
                            fmt::format("Run it to its end: {}", run_again(folder, " --resume"))));
    return std::nullopt;
  }
  try {
    const std::string bytes = read_file(file);
    StampingRecord record = read_stamping_record(Hdf5Reader(bytes));
    if (record.complete()) return record;
    problems.push_back(problem_of_stamping(
        folder,
        fmt::format("stopped at step {} of {}: it holds no formed part", record.at.step, record.steps),
        "Its report says why, and what to try."));
  } catch (const Hdf5Error& error) {
    problems.push_back({"export.part.damaged"_rule, "folder", file.string(), error.what(),
                        fmt::format("Make it anew: {}", run_again(folder, " --force"))});
  }
  return std::nullopt;
}

}  // namespace

bool hands_over_a_part(const Case& a_case) {
  return a_case.stamping && a_case.stamping->blank.plies == 1 && tables_shear(a_case);
}

FormedPart read_formed_part(const fs::path& folder, const Case& a_case) {
  Problems problems;
  if (a_case.stamping->blank.plies > 1)
    problems.push_back(
        {"export.part.plies"_rule, "blank.plies", fmt::format("{}", a_case.stamping->blank.plies),
         "is more than one: plies that slipped are as many surfaces, and no laminate of one mesh",
         "Export the part of a run with `blank.plies: 1`.", folder.string()});
  const fs::path stiffness = folder / "mesoscale/stiffness.json";
  if (!tables_shear(a_case) || !fs::is_regular_file(stiffness))
    problems.push_back(
        {"export.part.solid"_rule, "solid.shear_angles", "",
         "must list two angles or more: the part's stiffness follows the trellis angle",
         fmt::format(
             "Run it once more; the stamping comes out of the cache: {}",
             run_again(folder,
                       " --set 'solid={per_pitch: 32, layers: 32, shear_angles: [0 deg, 15 deg, 30 deg, "
                       "45 deg, 60 deg]}' --force")),
         folder.string()});
  const std::optional<StampingRecord> record = record_in(folder, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return {macroscale::whole_of(record->at.blank).state,
          read_sheared_json(read_file(stiffness), stiffness.string()),
          mesoscale::fabric_geometry(*a_case.cell).mass.areal_density};
}

}  // namespace heddle::pipeline
