#include "pipeline/report.h"

#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "pipeline/report_figures.h"
#include "sample_run.h"

using namespace heddle;
using namespace heddle::pipeline;
using Catch::Matchers::Contains;

namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size()))
    ++found;
  return found;
}

/// The one verdict that holds these words.
Verdict verdict_with(const ReportInput& input, const std::string& words) {
  const std::vector<Verdict> all = verdicts(input);
  const auto has = [&](const Verdict& verdict) { return verdict.text.find(words) != std::string::npos; };
  INFO("looking for: " << words);
  REQUIRE(std::count_if(all.begin(), all.end(), has) == 1);
  return *std::find_if(all.begin(), all.end(), has);
}

/// Every element that is opened is closed, in order. Enough HTML for the pages written here.
std::string first_fault_of_nesting(const std::string& html) {
  static const std::vector<std::string> empty_elements{"meta", "br", "!doctype", "path", "circle"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return "a tag is not closed";
    const bool closing = html[at + 1] == '/';
    const std::size_t first = at + (closing ? 2 : 1);
    const std::string name = html.substr(first, html.find_first_of(" />", first) - first);
    if (closing) {
      if (open.empty() || open.back() != name)
        return "</" + name + "> closes <" + (open.empty() ? "" : open.back()) + ">";
      open.pop_back();
    } else if (html[end - 1] != '/' &&
               std::find(empty_elements.begin(), empty_elements.end(), name) == empty_elements.end()) {
      open.push_back(name);
    }
    at = end;
  }
  return open.empty() ? "" : "<" + open.back() + "> is never closed";
}

}  // namespace

TEST_CASE("equal runs give reports with equal bytes", "[report]") {
  CHECK(report_html(sample::report()) == report_html(sample::report()));
  ReportInput other = sample::report();
  other.stamping->peak_punch_force += 1.0;
  CHECK(report_html(other) != report_html(sample::report()));
}

TEST_CASE("a report is one page that needs no network", "[report]") {
  const std::string html = report_html(sample::report());
  CHECK(first_fault_of_nesting(html) == "");
  for (const char* outside : {"http://", "https://", "url(", "@import", "<script", "<link", "src="}) {
    INFO(outside);
    CHECK(count(html, outside) == 0);
  }
  CHECK(count(html, "nan") == 0);
  CHECK(count(html, "inf\"") == 0);
  CHECK(html.size() < 1'500'000);
  CHECK(first_fault_of_nesting("<main><p></main>") != "");  // the check can fail
}

TEST_CASE("a full report holds every picture and table", "[report]") {
  const std::string html = report_html(sample::report());
  CHECK(count(html, "<svg") == 13);
  CHECK(count(html, "<figcaption>") == 13);
  for (const char* title : {"The formed part", "Forces and motion", "Is the answer sound?", "The weave",
                            "Contact and friction", "What it rests on", "Friction tests"}) {
    CHECK_THAT(html, Contains(title));
  }
}

TEST_CASE("the friction test as a machine shows its pulls, its trends and its plates", "[report]") {
  ReportInput input;
  input.name = "rig";
  input.friction_rig = sample::friction_rig();
  input.friction_history = sample::friction_history();
  input.plates = {
      {"flat", 3, 2, 0.05, 0.1, {1e5, 1e5, 1.5e5, 1.5e5, 2e5, 2e5}, {1e5, 1e5, 1e5, 1e5, 1e5, 1e5}}};
  const std::string html = report_html(input);
  CHECK(first_fault_of_nesting(html) == "");
  CHECK_THAT(html, Contains("Friction report") && Contains("The friction test as a machine"));
  // Pull and normal force; force and mu against speed, which alone is varied; both plates.
  CHECK(count(html, "<svg") == 6);
  // Measured pulls are dots and not lines: two, in both charts; the finite elements six.
  CHECK(count(html, "class=\"dot s1\"") == 4);
  CHECK(count(html, "class=\"dot s2\"") == 12);
  CHECK(count(html, "paper&#39;s model") + count(html, "paper's model") == 0);  // none was given
  input.film = friction::film_conduction({}, 0.07e-3);
  CHECK(count(report_html(input), "<svg") == 7);
  // Without a loss of load there is nothing to show of it.
  for (auto& row : input.friction_history) row.normal_force = 1500.0;
  CHECK(count(report_html(input), "<svg") == 6);
}

TEST_CASE("sections without data are left out of the report", "[report]") {
  ReportInput bare;
  bare.name = "bare";
  const std::string html = report_html(bare);
  CHECK(first_fault_of_nesting(html) == "");
  CHECK(count(html, "<svg") == 0);
  CHECK(count(html, "<h2>") == 0);

  ReportInput weave;
  weave.name = "weave only";
  weave.cell = sample::cell();
  weave.section = sample::section();
  const std::string page = report_html(weave);
  CHECK(count(page, "<svg") == 1);
  CHECK(count(page, "<h2>") == 1);
  CHECK_THAT(page, Contains("Unit-cell report"));
}

TEST_CASE("names and notes with markup appear as text", "[report]") {
  ReportInput input = sample::report();
  input.name = "<b>&\"bold\"";
  input.notes = {"p < 5 kPa & mu > 0.3"};
  const std::string html = report_html(input);
  CHECK_THAT(html, Contains("&lt;b&gt;&amp;&quot;bold&quot;"));
  CHECK_THAT(html, Contains("p &lt; 5 kPa &amp; mu &gt; 0.3"));
  CHECK(count(html, "<b>") == 0);
}

TEST_CASE("an energy ledger within one per cent closes, and beyond it fails", "[report][verdict]") {
  ReportInput input = sample::report();
  CHECK(verdict_with(input, "The energy ledger closes").tone == Tone::holds);
  input.stamping->energy_residual_max = 0.0101;
  CHECK(verdict_with(input, "The energy ledger does not close").tone == Tone::fails);
  input.stamping->energy_residual_max = std::numeric_limits<double>::quiet_NaN();
  CHECK(verdict_with(input, "The energy ledger does not close").tone == Tone::fails);
}

TEST_CASE("forces out of balance by more than a thousandth fail", "[report][verdict]") {
  ReportInput input = sample::report();
  CHECK(verdict_with(input, "Forces balance").tone == Tone::holds);
  input.stamping->force_balance_residual_max = 1.1e-3;
  CHECK(verdict_with(input, "Forces do not balance").tone == Tone::fails);
}

TEST_CASE("a blank that breaks the symmetry of the square is said to, and one without it is not blamed",
          "[report][verdict]") {
  ReportInput input = sample::report();
  CHECK(verdict_with(input, "share the eight symmetries").tone == Tone::holds);
  input.stamping->symmetry_gap_draw_in = 0.04;
  CHECK(verdict_with(input, "break the eight symmetries").tone == Tone::attention);
  input.stamping->symmetry_gap_shear = -1.0;
  CHECK(verdict_with(input, "nothing to check by symmetry").tone == Tone::note);
}

TEST_CASE("whatever is not physics is named in the report", "[report][verdict]") {
  ReportInput input = sample::report();
  CHECK(verdict_with(input, "Nothing non-physical").tone == Tone::holds);
  input.artefact.mass_scaling = 1000.0;
  CHECK(verdict_with(input, "mass is scaled by 1000").tone == Tone::attention);
  input.artefact.stabilisation = 50.0;
  CHECK(verdict_with(input, "damping of 50 N s/m³").tone == Tone::attention);
  for (const Verdict& verdict : verdicts(input))
    CHECK(verdict.text.find("Nothing non-physical") == std::string::npos);
}

TEST_CASE("friction work outside the calibrated range is stated as a share", "[report][verdict]") {
  ReportInput input = sample::report();
  CHECK(verdict_with(input, "3.1 % of the friction work").tone == Tone::note);
  input.stamping->friction_work_outside = 0.34;
  CHECK(verdict_with(input, "34 % of the friction work").tone == Tone::attention);
  input.stamping->friction_work_outside = 0.0;
  CHECK(verdict_with(input, "All friction work").tone == Tone::holds);
  input.stamping->falling_branch = true;
  CHECK(verdict_with(input, "fell with speed").tone == Tone::attention);
}

TEST_CASE("a run that stopped early says where and why", "[report][verdict]") {
  ReportInput input = sample::report();
  input.history.resize(43);
  input.stamping->completed = false;
  input.stamping->failure = "step halved 8 times at 30.1 mm";
  const Verdict verdict = verdict_with(input, "step halved 8 times");
  CHECK(verdict.tone == Tone::fails);
  CHECK_THAT(verdict.text, Contains("30.1 mm in 0.185 s"));
}

TEST_CASE("shear beyond gap closure and beyond locking reads differently", "[report][verdict]") {
  ReportInput input = sample::report();
  CHECK(verdict_with(input, "beyond gap closure at 30.6°").tone == Tone::note);
  input.stamping->shear_angle_max = 0.9;
  CHECK(verdict_with(input, "beyond the locking angle").tone == Tone::attention);
  input.stamping->shear_angle_max = 0.4;
  CHECK(verdict_with(input, "below gap closure").tone == Tone::note);
}

TEST_CASE("priors of the fabric are counted and named", "[report][verdict]") {
  CHECK_THAT(verdict_with(sample::report(), "are priors").text,
             Contains("3 constants of the fabric") && Contains("compaction_modulus, tow_friction, bonding"));
}

TEST_CASE("the error against friction tests is the root mean square over those that were measured",
          "[report][verdict]") {
  // Table 4's published model against its measurements: -4.6, -5.4 and +7.9 %.
  CHECK_THAT(
      verdict_with(sample::report(), "measured friction tests").text,
      Contains("3 measured") && Contains("off by 0.37 %") && Contains("published model is off by 6.1 %"));
}

TEST_CASE("the residual counts against at least one per cent of the final work", "[report]") {
  std::vector<macroscale::HistoryRow> rows(2);
  rows[0].work_punch = 0.0, rows[0].ledger_residual = 1e-3;
  rows[1].work_punch = 10.0, rows[1].ledger_residual = 0.05;
  const std::vector<double> shares = residual_shares(rows);
  CHECK(shares[0] == Approx(1e-2).epsilon(1e-14));
  CHECK(shares[1] == Approx(5e-3).epsilon(1e-14));
}

TEST_CASE("a blank whose nodes do not fit its cells is refused", "[report]") {
  ReportInput input = sample::report();
  input.blank->position.pop_back();
  CHECK_THROWS_WITH(report_html(input), Contains("blank of 64 x 64 cells"));
}

TEST_CASE("a fine blank is drawn with as many quads as a page can carry", "[report]") {
  CHECK(formed_picture(sample::blank(300)).inline_svg().size() < 500'000);
}

TEST_CASE("the sample report can be looked at", "[report]") {
  // Writes the page where the developer asks for it; always checks that it reaches the disk whole.
  const char* wanted = std::getenv("HEDDLE_SAMPLE_REPORT");
  const std::filesystem::path path = wanted ? std::filesystem::path(wanted)
                                            : std::filesystem::temp_directory_path() /
                                                  ("heddle_sample_report_" + std::to_string(::getpid())) /
                                                  "report.html";
  const std::string html = report_html(sample::report());
  write_file(path, html);
  CHECK(read_file(path) == html);
  if (!wanted) std::filesystem::remove_all(path.parent_path());
}
