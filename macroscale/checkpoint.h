#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/hdf5_file.h"
#include "macroscale/scene.h"
#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// All that a stamping hands from one step to the next: with it and the same specification a run goes on to
/// the same bits. Friction loads (the lag) and contact stiffness follow from the state at the start of each
/// step, so they are not here; the contact memory is in `state`.
struct StampingCheckpoint {
  int step = 0;                     ///< steps done; 0 = the binder has closed
  State state;                      ///< after it
  HistoryRow row;                   ///< after it; the cumulative columns go on from here
  double peak_force_balance = 0.0;  ///< largest over the parts of all steps [N]
  double peak_pressure = 0.0;       ///< of any node on any tool [Pa]
  double peak_swing = 0.0;          ///< share of friction that swung in an accepted step [-]
  bool falling_branch = false;
  int patterns = 0;      ///< of the matrix between plies, made anew
  double pairing = 0.0;  ///< sum of sizes of StepLedger::pairing [J]
  int rejected_steps = 0, newton_iterations = 0, factorisations = 0;
  std::vector<HistoryRow> history;  ///< one row a step done
  std::vector<HeatRow> hold;        ///< after the last step, where there is a hold
  std::optional<Release> release;   ///< after all, where there is one
  BlankState blank;                 ///< after it, for files and pictures
};

/// Writes below a group ("/stamping"). Every number keeps its bits.
void write(Hdf5Writer& file, const std::string& group, const StampingCheckpoint& checkpoint);
/// @throws Hdf5Error  if something is missing or sizes contradict each other
StampingCheckpoint read_checkpoint(const Hdf5Reader& file, const std::string& group);

/// The blank of one instant without what all instants share (cells, reference, quads).
void write_instant(Hdf5Writer& file, const std::string& group, const BlankState& blank);
/// @param shared  any instant of the same blank
BlankState read_instant(const Hdf5Reader& file, const std::string& group, const BlankState& shared);

/// What a state has to have, by the specification alone.
struct StateSizes {
  int tools = 0, unknowns_of_tools = 0;
  bool self_contact = false;  ///< whether it may hold what the faces of cells remember of other parts
};

/// Fault that keeps a checkpoint from being of a stamping of this blank in so many steps, or "".
std::string fault_of(const StampingCheckpoint& checkpoint, const Blank& blank, ContactSites sites, int steps,
                     const StateSizes& sizes);

}  // namespace heddle::macroscale
