#include <cstdarg>
#include <cstdio>

#include "campaign.h"

namespace blindgen {

namespace {

constexpr double zero_celsius = 273.15;
constexpr double degrees = 180.0 / 3.14159265358979323846;

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  char buffer[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

std::string conditions_text(const Condition& c) {
  return text("%.6g,%.6g,%.6g,%.6g,%.6g,%.6g", c.velocity * 1e3, c.normal_force,
              c.tool_temperature - zero_celsius, c.fabric_temperature - zero_celsius, c.orientation * degrees,
              c.dwell);
}

std::string list_text(const std::vector<int>& numbers) {
  std::string list = "[";
  for (const int number : numbers) list += (list.size() > 1 ? ", " : "") + std::to_string(number);
  return list + "]";
}

}  // namespace

std::string data_text(const Campaign& campaign) {
  std::string file =
      "condition_id,sample_id,day_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,"
      "orientation_deg,dwell_s,time_s,displacement_mm,pull_force_N,normal_force_measured_N\n";
  for (const Row& row : campaign.rows) {
    file += text("c%02d,s%04d,d%02d,", row.condition, row.sample, row.day) + conditions_text(row.nominal) +
            text(",%.5g,%.4f,%.2f,", row.time, row.slip * 1e3, row.force) +
            (row.normal_force ? text("%.1f", *row.normal_force) : "") + "\n";
  }
  return file;
}

std::string sidecar_text() {
  return "rig: {plate_area: 0.01 m^2, faces: 2}\n"
         "provenance: {source: \"pull-out coupons of a made world\", kind: synthetic}\n";
}

std::string truth_text(const Spec& spec, const Case& hidden, const Campaign& campaign) {
  const Melt& melt = hidden.world.melt;
  const StribeckCurve& curve = hidden.world.curve;
  std::string file = text("{\"seed\": %llu, \"case\": %d, \"kind\": \"%s\", \"design\": \"%s\",\n",
                          static_cast<unsigned long long>(spec.seed), spec.case_number,
                          std::string(name_of(spec.kind)).c_str(), std::string(name_of(spec.design)).c_str());
  file += text(" \"sample_scatter\": %.6g, \"day_scatter\": %.6g, \"amplitude\": %.6g,\n \"effects\": [",
               spec.sample_scatter, spec.day_scatter, spec.amplitude);
  for (std::size_t i = 0; i < hidden.hidden.size(); ++i) {
    const Hidden& h = hidden.hidden[i];
    file += text("%s{\"id\": \"%s\", \"size\": %.6g, \"size_asked\": %.6g, \"strength\": %.6g}",
                 i > 0 ? ", " : "", h.id.c_str(), h.size, h.asked, h.strength);
  }
  file += text(
      "],\n \"melt\": {\"index\": %.6g, \"zero_shear_Pa_s\": %.6g, \"relaxation_s\": %.6g, \"yasuda\": %.6g, "
      "\"power_law\": %s},\n",
      melt.index, melt.zero_shear, melt.relaxation, melt.yasuda, melt.exact ? "true" : "false");
  file += text(
      " \"curve\": {\"form\": %d, \"low\": %.6g, \"high\": %.6g, \"exponent\": %.6g, \"balance\": %.6g},\n",
      static_cast<int>(curve.form), curve.low, curve.high, curve.exponent, curve.balance);
  return file +
         text(" \"days\": %d, \"mislabelled_sample\": %d, \"missing_conditions\": ", campaign.days,
              campaign.mislabelled_sample) +
         list_text(campaign.missing_conditions) +
         ", \"swapped_conditions\": " + list_text(campaign.swapped_conditions) + "}\n";
}

}  // namespace blindgen
