#pragma once

#include <vector>

#include "mesoscale/study/cell_study.h"
#include "pipeline/config_reader.h"
#include "pipeline/config_schema.h"

namespace heddle::pipeline {

/// The keys below `study`.
std::vector<Key> cell_study_keys();

mesoscale::study::StudySpec study_of(const Settings& settings);

/// Problems of the study of a cell, and lists that hold a value twice.
Problems check_study(const mesoscale::study::StudySpec& spec, const mesoscale::CellSpec& cell);

}  // namespace heddle::pipeline
