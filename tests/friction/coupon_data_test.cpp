#include "friction/calibration/coupon_data.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace heddle;
using namespace heddle::friction;

namespace {

const std::string header =
    "condition_id,sample_id,day_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,"
    "orientation_deg,dwell_s,time_s,displacement_mm,pull_force_N,normal_force_measured_N\n";

/// Ids of all problems of a table.
std::vector<std::string> problems_of(const std::string& text, std::string* words = nullptr) {
  std::vector<std::string> ids;
  try {
    parse_coupons(text, "x.csv", {});
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      ids.push_back(problem.id.text());
      CHECK_FALSE(problem.way_out.empty());
    }
    if (words != nullptr) *words = error.what();
  }
  return ids;
}
using Ids = std::vector<std::string>;

const std::string short_header =
    "velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,force_measured_N\n";

}  // namespace

TEST_CASE("a history is cut to the mean of its second half, with the load that was measured",
          "[friction][calibration]") {
  std::string text = header;
  for (int i = 0; i <= 100; ++i)  // 10 N of drift over the pull; the load relaxes from 1500 to 1400
    text += fmt::format("base,1,mon,16.67,1500,85,180,30,2,{},{},{},{}\n", 0.03 * i, 0.5 * i,
                        i == 0 ? 0.0 : 840.0 + 0.1 * i, 1500 - i);
  const CouponData data = parse_coupons(text, "x.csv", {});
  REQUIRE(data.rows.size() == 1);
  const CouponRow& row = data.rows.front();
  CHECK(*row.pull.measured_force == Approx(847.5));
  CHECK(row.pull.normal_force == Approx(1425.0));
  CHECK(*row.slip == Approx(37.5e-3));
  CHECK(row.dwell == 2.0);
  CHECK(row.pull.orientation == Approx(0.5235987755982988));
  CHECK(data.notes.size() == 1);
  const CouponData stretches = parse_coupons(text, "x.csv", {.stretches = 5});
  CHECK(stretches.rows.size() == 5);
  CHECK(stretches.samples.size() == 1);
  for (std::size_t k = 1; k < 5; ++k) CHECK(*stretches.rows[k].slip > *stretches.rows[k - 1].slip);
}

TEST_CASE("samples, days and conditions are told apart", "[friction][calibration]") {
  std::string text = header;
  for (const char* day : {"mon", "tue"})
    for (const int sample : {1, 2})  // sample numbers start again each day
      for (const char* condition : {"base", "fast"})
        text += fmt::format("{},{},{},{},1500,85,180,0,0,,,{},\n", condition, sample, day,
                            condition[0] == 'b' ? 16.67 : 41.67, 850);
  const CouponData data = parse_coupons(text, "x.csv", {});
  CHECK(data.rows.size() == 8);
  CHECK(data.samples.size() == 8);
  CHECK(data.days == std::vector<std::string>{"mon", "tue"});
  CHECK(data.has_days());
  CHECK(data.conditions == 2);
  CHECK(data.rows[0].condition == data.rows[2].condition);
  // Without condition_id rows are alike whose numbers are.
  const CouponData plain = parse_coupons(
      short_header + "16,1500,85,180,850\n16,1500,85,180,860\n41,1500,85,180,900\n", "x.csv", {});
  CHECK(plain.conditions == 2);
  CHECK(plain.samples.size() == 3);
  CHECK_FALSE(plain.has_days());
}

TEST_CASE("a table that the friction test wrote is read by its measured force", "[friction][calibration]") {
  const CouponData data = parse_coupons(
      "case,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,friction_coefficient,"
      "pull_force_N,force_measured_N,force_error\nbase,16.67,1500,85,180,0.28,800,843,-0.05\n",
      "x.csv", {});
  CHECK(*data.rows.front().pull.measured_force == 843.0);
  CHECK(data.rows.front().pull.name == "base");
  CHECK(measured_coefficient(data.rows.front(), 2) == Approx(0.281));
  CHECK(measured_coefficient(data.rows.front(), 1) == Approx(0.562));  // a sled slides on one face
}

TEST_CASE("a table of coupons is refused with every problem and its line",
          "[friction][calibration][wrong input]") {
  std::string words;
  CHECK(problems_of("velocity_mm_s,normal_force_kN,tool_temperature_C,fabric_temperature_C\n16,1.5,85,180\n",
                    &words) == Ids{"friction.coupons.column.unknown", "friction.coupons.column.missing",
                                   "friction.coupons.column.missing"});
  CHECK(words.find("Convert its numbers and call it normal_force_N") != std::string::npos);
  CHECK(problems_of(short_header + "16,1500,85,warm,850\n16,1500,85,180,\n") ==
        Ids{"friction.coupons.number"});
  CHECK(problems_of(short_header + "16,1500,85,180,\n") == Ids{"friction.coupons.force"});
  CHECK(problems_of(short_header + "-16,0,85,180,850\n") ==
        Ids{"friction.coupons.positive", "friction.coupons.positive"});
  CHECK(problems_of(short_header) == Ids{"friction.coupons.empty"});
  CHECK(problems_of("velocity_mm_s," + short_header + "16,16,1500,85,180,850\n") ==
        Ids{"friction.coupons.column.twice"});
  // kN in one of the two forces gives a coefficient a thousand times off; kelvin is far too hot.
  CHECK(problems_of(short_header + "16,1500,85,180,0.843\n", &words) == Ids{"friction.coupons.unit.force"});
  CHECK(words.find("kN") != std::string::npos);
  CHECK(problems_of(short_header + "16,1.5,85,180,843\n") == Ids{"friction.coupons.unit.force"});
  // A table in kN is one fault, however long, in the column it has.
  CHECK(problems_of("velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,pull_force_N\n"
                    "16,1500,85,180,0.843\n8,1500,85,180,0.8\n4,1500,85,180,0.7\n",
                    &words) == Ids{"friction.coupons.unit.force"});
  CHECK(words.find("pull_force_N (line 2)") != std::string::npos);
  CHECK(words.find("so do 2 forces more") != std::string::npos);
  CHECK(problems_of(short_header + "16,1500,358.15,453.15,843\n") ==
        Ids{"friction.coupons.unit.temperature", "friction.coupons.unit.temperature"});
  CHECK(problems_of(header +
                    "base,1,mon,16,1500,85,180,0,0,1,,850,\nbase,1,mon,16,1500,85,180,0,0,2,,860,\n") ==
        Ids{"friction.coupons.history"});
  CHECK(problems_of(header +
                    "base,1,mon,16,1500,85,180,0,0,1,0,850,\nbase,1,mon,16,1500,85,180,0,0,2,0,860,\n") ==
        Ids{"friction.coupons.history"});  // nothing slides
}

TEST_CASE("a table wholly in kN or m/s looks odd and says so", "[friction][calibration][wrong input]") {
  const CouponData small = parse_coupons(short_header + "16,1.5,85,180,0.843\n", "x.csv", {});
  REQUIRE(small.notes.size() == 1);
  CHECK(small.notes[0].find("in kN") != std::string::npos);
  const CouponData slow = parse_coupons(short_header + "0.01667,1500,85,180,843\n", "x.csv", {});
  REQUIRE(slow.notes.size() == 1);
  CHECK(slow.notes[0].find("in m/s") != std::string::npos);
}
