#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "bad_files.h"
#include "core/text_file.h"
#include "tests/source_dir.h"

using namespace heddle;

namespace {

const std::filesystem::path source = heddle::test::source_dir;

/// The names of all rules in some source text, and the places where one is written so that it cannot be read.
struct RuleNames {
  std::map<std::string, std::string> places;  ///< of each name: "core/csv.cpp:52"
  std::vector<std::string> faults;
};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Reads C++ just far enough to tell strings from comments. Whatever ends with _rule or _family after a quote
/// is a name, and must be one plain string: RuleId can be made in no other way (core/problem.h).
class SourceReader {
 public:
  SourceReader(std::string text, std::string file, RuleNames& names)
      : text_(std::move(text)), file_(std::move(file)), names_(names) {}

  void read() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (starts("//")) {
        skip_to("\n");
      } else if (starts("/*")) {
        skip_past("*/");
      } else if (c == '"') {
        read_string();
      } else if (c == '\'') {
        read_character();
      } else {
        if (std::isspace(static_cast<unsigned char>(c)) == 0) after_string_ = false;
        ++at_;
      }
    }
  }

 private:
  bool starts(const char* mark) const {
    return text_.compare(at_, std::char_traits<char>::length(mark), mark) == 0;
  }

  void advance(std::size_t to) {
    const std::size_t end = std::min(to, text_.size());
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    at_ = end;
  }
  void skip_to(const std::string& mark) { advance(text_.find(mark, at_)); }
  void skip_past(const std::string& mark) {
    const std::size_t found = text_.find(mark, at_);
    advance(found == std::string::npos ? found : found + mark.size());
  }

  /// 'x', '\'' and the separator of 1'000, which stands behind a digit.
  void read_character() {
    if (at_ > 0 && std::isxdigit(static_cast<unsigned char>(text_[at_ - 1])) != 0) {
      ++at_;
      return;
    }
    ++at_;
    while (at_ < text_.size() && text_[at_] != '\'') at_ += text_[at_] == '\\' ? 2 : 1;
    ++at_;
  }

  void read_string() {
    const bool raw = at_ > 0 && text_[at_ - 1] == 'R';
    const std::size_t begin = at_ + 1;
    if (raw) {
      const std::size_t open = text_.find('(', begin);
      skip_past(")" + text_.substr(begin, open - begin) + "\"");
    } else {
      ++at_;
      while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
      ++at_;
    }
    const std::string content = text_.substr(begin, at_ - 1 - begin);
    std::string suffix;
    while (at_ < text_.size() && is_word(text_[at_])) suffix += text_[at_++];
    if (suffix == "_rule" || suffix == "_family") add(content, raw || after_string_);
    after_string_ = true;
  }

  void add(const std::string& name, bool composed) {
    const std::string place = file_ + ":" + std::to_string(line_);
    if (name.empty() && file_ == "core/problem.h") return;  // where the two suffixes are defined
    const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return std::islower(static_cast<unsigned char>(c)) != 0 ||
             std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '*';
    });
    if (composed || !plain)
      names_.faults.push_back(place + ": the name of a rule is one plain string");
    else
      names_.places.emplace(name, place);
  }

  std::string text_, file_;
  RuleNames& names_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool after_string_ = false;
};

RuleNames rules_in(const std::string& text, const std::string& file = "x.cpp") {
  RuleNames names;
  SourceReader(text, file, names).read();
  return names;
}

RuleNames rules_of_the_program() {
  RuleNames names;
  for (const char* room : {"core", "friction", "mesoscale", "macroscale", "pipeline"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / room)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      const std::string file = std::filesystem::relative(entry.path(), source).generic_string();
      SourceReader(read_text_file(entry.path()), file, names).read();
    }
  }
  return names;
}

/// Ids and names met by the files of tests/pipeline/bad: a single rule is met by its id, whoever found it
/// (the schema and a room may state the same one); a family by any of its members.
std::set<std::string> rules_met() {
  std::set<std::string> met;
  for (const std::string& name : test::bad_file_names()) {
    for (const Problem& problem : test::problems_of_bad_file(name)) {
      met.insert(problem.id.text());
      met.insert(std::string(problem.id.name()));
    }
  }
  return met;
}

/// A rule that no configuration can break, and the test that breaks it.
struct Elsewhere {
  const char* rule;
  const char* file;  ///< below tests
  const char* test;
  const char* why;
};

const char* const of_fabric = "mesoscale/fabric_properties_test.cpp";
const char* const of_json = "pipeline/outputs_test.cpp";
const char* const of_coupons = "friction/coupon_data_test.cpp";
const char* const of_stampings = "pipeline/discover_stamping_test.cpp";
const char* const of_shear_tests = "pipeline/shear_tests_test.cpp";
const char* const of_fit = "friction/coupon_fit_test.cpp";
const char* const of_design = "pipeline/discover/plan_test.cpp";
const char* const of_discovery = "pipeline/discover/discovery_test.cpp";
const char* const of_effects = "pipeline/discover/effects_test.cpp";
const char* const of_texgen = "mesoscale/solid/texgen_test.cpp";
const char* const part_refusals =
    "a part that cannot go out is refused with what is missing and the command that makes it";
const char* const of_outline = "macroscale/outline_test.cpp";

const std::vector<Elsewhere> elsewhere{
    {"file.missing", "core/text_file_test.cpp",
     "a file that cannot be read is refused under the rule it breaks",
     "the file under check itself, or one that vanished since"},
    {"file.folder", "core/text_file_test.cpp",
     "a file that cannot be read is refused under the rule it breaks",
     "the file under check itself, or one that vanished since"},
    {"file.unreadable", "core/text_file_test.cpp",
     "a file that cannot be read is refused under the rule it breaks",
     "the file under check itself, or one that vanished since"},
    {"friction.hersey_table.empty", "friction/law_forms_test.cpp",
     "bad numbers of laws, rheologies and effects are named with rule and way out",
     "a table that was read has its curve"},
    {"film.*.range", "mesoscale/film_test.cpp",
     "samples, fill and roughness outside their range are refused together",
     "of a film that no key asks for yet"},
    {"film.fill.closed", "mesoscale/reynolds_test.cpp",
     "a closed film is refused: nothing fixes the level of its pressure",
     "of a film that no key asks for yet"},
    {"level_set.voxel.range", "mesoscale/level_set_test.cpp", "a voxel that cannot hold a tow is refused",
     "a check of the cell, not a key"},
    {"fabric.*.empty", of_fabric, "an empty fabric is refused table by table",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.*.range", of_fabric, "numbers out of range are named",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.*.monotone", of_fabric, "tables that fall are named with the place",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.compaction.start", of_fabric,
     "compaction must start at nothing and area must stay below the plate",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.tension_energy.convex", of_fabric, "an energy that is not convex is named with the strains",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.json.syntax", of_json, "a damaged fabric file is refused with every fault named",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.json.*.missing", of_json, "a damaged fabric file is refused with every fault named",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.json.*.type", of_json, "a damaged fabric file is refused with every fault named",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.json.*.unknown", of_json, "a damaged fabric file is refused with every fault named",
     "the fabric is computed, or read from a file of the program"},
    {"fabric.json.*.table", of_json, "a damaged fabric file is refused with every fault named",
     "the fabric is computed, or read from a file of the program"},
    {"*.empty", "macroscale/mesh_check_test.cpp",
     "each fault of a mesh is named with its place and a way out",
     "said of the file before the mesh is made"},
    {"*.index", "macroscale/mesh_check_test.cpp",
     "each fault of a mesh is named with its place and a way out",
     "said of the file before the mesh is made"},
    {"*.finite", "macroscale/mesh_check_test.cpp",
     "each fault of a mesh is named with its place and a way out",
     "said of the file before the mesh is made"},
    {"*.band.range", "macroscale/tool_band_test.cpp",
     "a band too large, too narrow or for a tool too thin is refused with the way out",
     "the width is computed from steps and thickness"},
    {"*.file.triangles", "macroscale/tool_file_test.cpp", "five million triangles are refused at once",
     "a file too large to be kept here"},
    {"*.file.missing", "macroscale/tool_file_test.cpp", "files that are no tools are refused with the reason",
     "said by the schema: the key names no file"},
    {"*.file.folder", "macroscale/tool_file_test.cpp", "files that are no tools are refused with the reason",
     "said by the schema: the key names no file"},
    {"*.file.unreadable", "macroscale/tool_file_test.cpp", "a tool file that only others may read is refused",
     "an access right, which the repository cannot hold"},
    {"*.file.size", "macroscale/step_test.cpp",
     "STEP files that cannot be meshed are refused with the reason", "a file too large to be kept here"},
    {"*.points", of_outline, "each fault of an outline is named with its place",
     "the keys of the blank give no border that breaks it"},
    {"*.orientation", of_outline, "each fault of an outline is named with its place",
     "the keys of the blank give no border that breaks it"},
    {"*.size", of_outline, "each fault of an outline is named with its place",
     "the keys of the blank give no border that breaks it"},
    {"blank.outline.circle.range", of_outline, "each fault of an outline is named with its place",
     "the keys of the blank give no border that breaks it"},
    {"output.folder.file", "pipeline/run_test.cpp", "what only a command can break is refused under its rule",
     "of a command, not of a configuration"},
    {"output.folder.stamped", "pipeline/run_test.cpp",
     "what only a command can break is refused under its rule", "of a command, not of a configuration"},
    {"output.folder.other", "pipeline/run_test.cpp",
     "what only a command can break is refused under its rule", "of a command, not of a configuration"},
    {"output.folder.create", "pipeline/run_test.cpp",
     "what only a command can break is refused under its rule", "of a command, not of a configuration"},
    {"case.part", "pipeline/run_test.cpp", "what only a command can break is refused under its rule",
     "of a command, not of a configuration"},
    {"friction.contact_pressure.weave", "pipeline/run_test.cpp",
     "what only a command can break is refused under its rule", "of a command, not of a configuration"},
    {"run.resume.damaged", "pipeline/resume_test.cpp",
     "going on with other inputs is refused and names what changed, and a damaged checkpoint too",
     "of a command, not of a configuration"},
    {"run.resume.changed", "pipeline/resume_test.cpp",
     "going on with other inputs is refused and names what changed, and a damaged checkpoint too",
     "of a command, not of a configuration"},
    {"cases.id.word", "pipeline/case_list_test.cpp",
     "ids of a list that repeat or cannot name a folder are refused, all at once",
     "of a command, not of a configuration"},
    {"cases.id.unique", "pipeline/case_list_test.cpp",
     "ids of a list that repeat or cannot name a folder are refused, all at once",
     "of a command, not of a configuration"},
    {"cases.record", "pipeline/case_list_test.cpp",
     "a record that cannot be read counts as none, and says so", "of a command, not of a configuration"},
    {"friction.coupons.column.unknown", of_coupons,
     "a table of coupons is refused with every problem and its line", "of --data, not of a configuration"},
    {"friction.coupons.column.missing", of_coupons,
     "a table of coupons is refused with every problem and its line", "of --data, not of a configuration"},
    {"friction.coupons.column.twice", of_coupons,
     "a table of coupons is refused with every problem and its line", "of --data, not of a configuration"},
    {"friction.coupons.number", of_coupons, "a table of coupons is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"friction.coupons.empty", of_coupons, "a table of coupons is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"friction.coupons.positive", of_coupons, "a table of coupons is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"friction.coupons.force", of_coupons, "a table of coupons is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"friction.coupons.history", of_coupons, "a table of coupons is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"friction.coupons.unit.temperature", of_coupons,
     "a table of coupons is refused with every problem and its line", "of --data, not of a configuration"},
    {"friction.coupons.unit.force", of_coupons,
     "a table of coupons is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.shear.empty", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.size", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.fabric", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.strip", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.test", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.speed", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.curve", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.short", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.reach", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.unit.displacement", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.unit.force", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.column.unknown", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.column.missing", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.column.twice", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.number", of_shear_tests,
     "a table of shear tests is refused with every problem and its line",
     "of --data, not of a configuration"},
    {"discover.shear.case", of_shear_tests, "shear tests of a case without a weave are refused",
     "of the command with its data, not of a configuration"},
    {"discover.stampings.empty", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.positive", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.unit.temperature", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.unit.stroke", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.unit.force", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.curve", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.short", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.column.unknown", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.column.missing", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.column.twice", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.number", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.condition", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.force", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.alike", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.overlap", of_stampings,
     "a table of stampings is refused with every problem and its line", "of --data, not of a configuration"},
    {"discover.stampings.parameters", of_stampings,
     "a case that cannot be asked about stampings is refused with the reason",
     "of a command, not of a configuration"},
    {"discover.stampings.calibrated", of_stampings,
     "a case that cannot be asked about stampings is refused with the reason",
     "of a command, not of a configuration"},
    {"discover.stampings.case", of_stampings,
     "a case that cannot be asked about stampings is refused with the reason",
     "of a command, not of a configuration"},
    {"calibrate.parameters.none", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"calibrate.parameters.acts", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"calibrate.parameters.twice", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"calibrate.bounds.order", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"calibrate.bounds.start", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"calibrate.prior.sd", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"calibrate.data.rows", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"calibrate.data.alike", of_fit, "a wish that cannot be answered is refused with every reason",
     "known once the data are read"},
    {"export.memory", "friction/export_test.cpp",
     "laws with a memory or a direction are refused with the reason, all at once",
     "of a command, not of a configuration"},
    {"export.direction", "friction/export_test.cpp",
     "laws with a memory or a direction are refused with the reason, all at once",
     "of a command, not of a configuration"},
    {"export.folder", "pipeline/calibrate_test.cpp", "an export without a case or a law is refused",
     "of a command, not of a configuration"},
    {"export.friction", "pipeline/calibrate_test.cpp", "an export without a case or a law is refused",
     "of a command, not of a configuration"},
    {"export.solid", "pipeline/study_test.cpp",
     "a solid cell goes out as a CalculiX deck, and without one the way out is named",
     "of a command, not of a configuration"},
    {"export.part.stamping", "pipeline/part_folder_test.cpp", part_refusals,
     "of a command, not of a configuration"},
    {"export.part.damaged", "pipeline/part_folder_test.cpp", part_refusals,
     "of a command, not of a configuration"},
    {"export.part.plies", "pipeline/part_folder_test.cpp", part_refusals,
     "of a command, not of a configuration"},
    {"export.part.solid", "pipeline/part_folder_test.cpp", part_refusals,
     "of a command, not of a configuration"},
    {"export.temperature", "pipeline/part_folder_test.cpp", part_refusals,
     "of a command, not of a configuration"},
    {"stiffness.file", "pipeline/part_folder_test.cpp", part_refusals, "of a file that a run wrote"},
    {"cell.voxels.file.box", of_texgen,
     "a deck that is none is refused with the rule it breaks and the place",
     "of what the deck holds; texgen_deck.yaml breaks the first of these rules"},
    {"cell.voxels.file.sets", of_texgen,
     "a deck that is none is refused with the rule it breaks and the place",
     "of what the deck holds; texgen_deck.yaml breaks the first of these rules"},
    {"cell.voxels.orientations.fibre", of_texgen,
     "a deck that is none is refused with the rule it breaks and the place",
     "of what the file holds; texgen_deck.yaml breaks the first of these rules"},
    {"ccx.displacements", "mesoscale/solid/ccx_test.cpp", "a result of CalculiX that is cut short is refused",
     "of a result, not of a configuration"},
    {"study.both", "pipeline/stamping_study_test.cpp",
     "a file that holds a study of cells and one of stampings is refused",
     "of a command, not of a configuration"},
    {"study.missing", "pipeline/study_test.cpp", "a case without a study is refused with the way out",
     "of a command, not of a configuration"},
    {"calibrate.friction", "pipeline/calibrate_test.cpp",
     "a calibration without friction, or of numbers that do not act, is refused",
     "of a command, not of a configuration"},
    {"discover.data.alike", of_discovery, "tables that cannot be discovered in are refused with the reason",
     "of --data or of a command, not of a configuration"},
    {"discover.sidecar.unknown", of_discovery,
     "tables that cannot be discovered in are refused with the reason",
     "of --data or of a command, not of a configuration"},
    {"discover.sidecar.plate_area", of_discovery,
     "tables that cannot be discovered in are refused with the reason",
     "of --data or of a command, not of a configuration"},
    {"discover.sidecar.faces", of_discovery,
     "tables that cannot be discovered in are refused with the reason",
     "of --data or of a command, not of a configuration"},
    {"discover.parameters.acts", of_discovery,
     "tables that cannot be discovered in are refused with the reason",
     "of --data or of a command, not of a configuration"},
    {"discover.effects.known", of_discovery,
     "tables that cannot be discovered in are refused with the reason",
     "of --data or of a command, not of a configuration"},
    {"discover.friction", of_discovery, "tables that cannot be discovered in are refused with the reason",
     "of --data or of a command, not of a configuration"},
    {"discover.effect.missing", of_effects, "an effect file says what is wrong with it, all at once",
     "of --effect, not of a configuration"},
    {"discover.effect.unknown", of_effects, "an effect file says what is wrong with it, all at once",
     "of --effect, not of a configuration"},
    {"discover.effect.stage", of_effects, "an effect file says what is wrong with it, all at once",
     "of --effect, not of a configuration"},
    {"discover.effect.prior", of_effects, "an effect file says what is wrong with it, all at once",
     "of --effect, not of a configuration"},
    {"discover.effect.off", of_effects, "an effect file says what is wrong with it, all at once",
     "of --effect, not of a configuration"},
    {"discover.effect.centre", of_effects, "an effect file says what is wrong with it, all at once",
     "of --effect, not of a configuration"},
    {"discover.design.column.unknown", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"discover.design.column.missing", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"discover.design.column.twice", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"discover.design.number", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"discover.design.range", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"discover.design.replicates", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"discover.design.empty", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"discover.design.alike", of_design, "a design is refused with every problem and its line",
     "of --design, not of a configuration"},
    {"environment.checkpoint_seconds", "pipeline/command_line_test.cpp",
     "a faulty interval in the environment is refused", "of a command, not of a configuration"},
};

/// The text of one test case, from its name to the next one.
std::string body_of_test(const std::string& file, const std::string& name) {
  const std::string text = read_text_file(source / "tests" / file);
  const std::size_t begin = text.find("TEST_CASE(\"" + name + "\"");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("\nTEST_CASE(", begin) - begin);
}

/// Whether the text names the rule, or for a family one of its members: "*.finite" in "tools.punch.finite",
/// or as ".finite" or "finite" where a helper puts the key in front.
bool names_rule(const std::string& text, const std::string& rule) {
  std::string pattern = std::regex_replace(rule, std::regex("\\."), "\\.");
  pattern = std::regex_replace(pattern, std::regex("^\\*\\\\\\."), "([a-z_.]*\\.)?");
  pattern = std::regex_replace(pattern, std::regex("^([^(]*)\\*"), "$1[a-z_.]+");
  return std::regex_search(text, std::regex("\"" + pattern + "\""));
}

}  // namespace

TEST_CASE("every rule of the source is met by a small bad file, or by the one test that can break it",
          "[pipeline][config][rules][long]") {
  const RuleNames rules = rules_of_the_program();
  for (const std::string& fault : rules.faults) FAIL_CHECK(fault);
  CHECK(rules.places.size() > 100);
  const std::set<std::string> met = rules_met();
  std::set<std::string> listed;
  for (const Elsewhere& entry : elsewhere) {
    INFO(entry.rule << ", in \"" << entry.test << "\" of tests/" << entry.file);
    CHECK(listed.insert(entry.rule).second);
    CHECK(rules.places.contains(entry.rule));  // the source still has it
    CHECK_FALSE(met.contains(entry.rule));     // or it needs no place here
    CHECK(names_rule(body_of_test(entry.file, entry.test), entry.rule));
  }
  for (const auto& [rule, place] : rules.places) {
    INFO(rule << ", in " << place);
    if (!met.contains(rule) && !listed.contains(rule))
      FAIL_CHECK("no file of tests/pipeline/bad breaks this rule");
  }
}

TEST_CASE("a rule without a bad file, and a name that cannot be read, are seen",
          "[pipeline][config][rules][long]") {
  const std::string text =
      "// \"in.a_comment\"_rule\n/* \"in.another\"_rule */ char c = '\"'; int n = 1'000;\n"
      "refuse(\"made.up\"_rule, \"a \\\" b\");\nrefuse( \"*.made_up\"_family.of(key));\n";
  const RuleNames rules = rules_in(text);
  CHECK(rules.faults.empty());
  CHECK(rules.places == std::map<std::string, std::string>{{"made.up", "x.cpp:3"}, {"*.made_up", "x.cpp:4"}});
  const std::set<std::string> met = rules_met();
  CHECK(met.contains("weave.gap.range"));
  CHECK_FALSE(met.contains("made.up"));
  CHECK_FALSE(met.contains("*.made_up"));

  CHECK(rules_in("refuse(\"made.\" \"up\"_rule);").faults.size() == 1);
  CHECK(rules_in("refuse(R\"(made.up)\"_rule);").faults.size() == 1);
  CHECK(rules_in("operator\"\"_rule(text, size);").faults.size() == 1);
  CHECK(rules_in("operator\"\"_rule(text, size);", "core/problem.h").faults.empty());

  CHECK(names_rule("CHECK(id == \"tools.punch.finite\");", "*.finite"));
  CHECK(names_rule("CHECK(id == \"fabric.bending.warp.range\");", "fabric.*.range"));
  CHECK(names_rule("refused(file, \"finite\")", "*.finite"));
  CHECK_FALSE(names_rule("CHECK(id == \"tools.punch.infinite\");", "*.finite"));
  CHECK_FALSE(names_rule("CHECK(id == \"yaml_syntax\");", "yaml.syntax"));
  CHECK(body_of_test("core/problem_test.cpp", "no such test").empty());
}
