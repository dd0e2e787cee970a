#include "pipeline/grid_error_stage.h"

#include <iostream>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "core/progress.h"
#include "macroscale/punch_profile.h"

namespace heddle::pipeline {

namespace {

// The same list writes and reads; the size tells when a member was added and must be named here too.
static_assert(sizeof(macroscale::GridError) == 10 * sizeof(double) + sizeof(std::string));
template <class Error>
auto numbers(Error& e) {
  return std::tie(e.spacing[0], e.spacing[1], e.companion_force, e.force, e.force_share, e.extrapolated_force,
                  e.shear_angle, e.draw_in);
}

}  // namespace

std::string bytes_of(const macroscale::GridError& error, const std::string& key) {
  Hdf5Writer file;
  file.write("/key", key);
  file.write("/kind", "grid_error");
  file.write("/known", error.known ? 1 : 0);
  file.write("/reason", error.reason);
  file.write("/nodes", error.nodes);
  const auto values = std::apply([](const auto&... v) { return std::vector<double>{v...}; }, numbers(error));
  file.write("/numbers", std::span<const double>(values));
  return file.finish();
}

macroscale::GridError read_grid_error(const Hdf5Reader& file) {
  if (file.text("/kind") != "grid_error") throw Hdf5Error("is no grid error");
  macroscale::GridError error;
  error.known = file.integer("/known") != 0;
  error.reason = file.text("/reason");
  error.nodes = file.integer("/nodes");
  const std::vector<double> values = file.doubles("/numbers");
  auto members = numbers(error);
  if (values.size() != std::tuple_size_v<decltype(members)>) throw Hdf5Error("/numbers is too short");
  std::size_t k = 0;
  std::apply([&](auto&... member) { ((member = values[k++]), ...); }, members);
  return error;
}

std::optional<macroscale::GridError> known_grid_error(const std::filesystem::path& folder, const Cache& cache,
                                                      const std::string& key) {
  if (auto found = cache.find(key, read_grid_error)) return found;
  const std::filesystem::path path = folder / grid_error_name;
  if (!std::filesystem::is_regular_file(path)) return std::nullopt;
  try {
    const Hdf5Reader file(read_file(path));
    if (file.text("/key") == key) return read_grid_error(file);
  } catch (const Hdf5Error&) {  // damaged: it is run again, and written over
  }
  return std::nullopt;
}

macroscale::GridError run_grid_error_stage(const macroscale::StampingSpec& spec,
                                           const mesoscale::FabricProperties& fabric,
                                           const friction::Model& friction,
                                           const macroscale::StampingResult& run, RunFolder& folder,
                                           const Cache& cache, const std::string& key,
                                           const std::function<bool()>& stop, bool quiet) {
  const auto work = [&](bool& reused) {
    if (auto found = known_grid_error(folder.path(), cache, key)) {
      reused = true;
      return std::move(*found);
    }
    Progress progress("grid error", macroscale::all_steps(spec.process),
                      progress_style_of_standard_error(quiet), std::cerr);
    macroscale::StampingControl control;
    control.observe = [&](int step, int, const macroscale::HistoryRow& row, const macroscale::BlankState&) {
      progress.update(step, fmt::format("punch {:.1f} mm", 1e3 * row.punch_displacement));
    };
    control.stop = stop;
    macroscale::GridError error = macroscale::grid_error(spec, fabric, friction, run, control);
    if (!stop()) cache.store(key, bytes_of(error, key));
    return error;
  };
  macroscale::GridError error = folder.stage("grid_error", work);
  if (!stop()) folder.write(grid_error_name, bytes_of(error, key));
  folder.log(error.known
                 ? fmt::format("grid error: {:.4g} N of {:.4g} N, companion on {:.4g} mm with {:.4g} N",
                               error.force, run.summary.peak_punch_force, 1e3 * error.spacing[0],
                               error.companion_force)
                 : "grid error: not known: " + error.reason);
  return error;
}

}  // namespace heddle::pipeline
