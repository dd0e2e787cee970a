#pragma once

#include "macroscale/shear_friction.h"
#include "mesoscale/fabric_properties.h"
#include "pipeline/coupon_report.h"

namespace heddle::pipeline {

/// What a picture frame shows of a fabric whose tows rub: to 20 and to 40 deg, each to both sides.
ShearLoop shear_loop(const mesoscale::FabricProperties& fabric, const macroscale::ShearFriction& friction);

}  // namespace heddle::pipeline
