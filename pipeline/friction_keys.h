#pragma once

#include <vector>

#include "friction/model.h"
#include "friction/rig/machine.h"
#include "pipeline/config_reader.h"
#include "pipeline/config_schema.h"

namespace heddle::pipeline {

/// Keys of the laws, rheologies and effects that describe their own numbers (friction/term.h): one block
/// each, `friction.ID`, `resin.ID`, `effects.ID`.
std::vector<Key> friction_law_keys();
std::vector<Key> rheology_keys();
std::vector<Key> friction_effect_keys();
/// Whether the film's temperature comes from conduction, and its constants.
std::vector<Key> conduction_keys();

/// Names for `friction.law` and `friction.form` beside stribeck, coulomb, power and linear.
std::vector<std::string> further_laws();
std::vector<std::string> further_forms();

/// The law, if it is one of those; a table is read from its file.
/// @throws InputError  if the table is at fault
std::optional<friction::Law> further_law_of(const Settings& settings, const std::filesystem::path& folder);

/// The friction rig as a machine: keys below friction_test.rig, which switch it on by being there.
std::vector<Key> rig_keys();
friction::Machine machine_of(const Settings& settings);

/// The film's conduction where the case asks for it, computed.
std::optional<friction::FilmConduction> conduction_of(const Settings& settings, double film_thickness);

friction::Rheology rheology_of(const Settings& settings);

/// Every effect given but the tool temperature shift.
void take_effects(const Settings& settings, friction::Effects& effects);

}  // namespace heddle::pipeline
