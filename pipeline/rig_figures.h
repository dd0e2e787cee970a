#pragma once

#include <vector>

#include "friction/film/film_conduction.h"
#include "pipeline/chart.h"
#include "pipeline/outputs.h"
#include "pipeline/picture.h"

/// The pictures of the friction test as a machine.
namespace heddle::pipeline {

/// One of the campaign's parameters.
enum class RigParameter { velocity, normal_force, tool_temperature, fabric_temperature, orientation };
enum class RigQuantity { pull_force, coefficient };

/// Force or mu against one parameter, all others at the baseline: the law, the machine, the finite elements,
/// and what was measured or computed by others. Empty where fewer than two rows differ in the parameter
/// alone.
/// @param rows  the first of them that is not measured is the baseline
std::optional<Canvas> rig_chart(const std::vector<FrictionRigRow>& rows, RigParameter parameter,
                                RigQuantity quantity);

/// Pull force against displacement of the first pulls, at most five.
Canvas pull_chart(const std::vector<FrictionHistoryRow>& history);
/// Normal force against time of the same pulls; empty where none lost any.
std::optional<Canvas> normal_force_chart(const std::vector<FrictionHistoryRow>& history);

/// Pressure on a plate, the pull to the right.
enum class Plate { lower, upper };
Canvas plate_picture(const PlatePressure& pressure, Plate plate);

/// Share of the tool in the film's temperature against time in contact.
Canvas film_chart(const friction::FilmConduction& film);

}  // namespace heddle::pipeline
