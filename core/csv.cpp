#include "core/csv.h"

#include <fmt/format.h>

#include "core/text_file.h"

namespace heddle {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

CsvRow row_of(std::string_view text, int line) {
  CsvRow row{line, {}};
  for (const std::string_view cell : split(text, ',')) row.cells.emplace_back(cell);
  return row;
}

// Spreadsheets of some countries write semicolons, others tabs: the header then has no comma at all.
std::string other_separator(std::string_view header) {
  if (header.find(',') != std::string_view::npos) return "";
  if (header.find(';') != std::string_view::npos) return "semicolons";
  return header.find('\t') != std::string_view::npos ? "tabs" : "";
}

[[noreturn]] void refuse(Rule id, const std::string& file, int line, std::string rule, std::string way_out) {
  throw InputError({{id, "", "", std::move(rule), std::move(way_out), file, line}});
}

}  // namespace

CsvTable parse_csv(std::string_view text, const std::string& file) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  if (text.find('\0') != std::string_view::npos)
    refuse("csv.encoding"_rule, file, 0, "is not plain text (it holds zero bytes; UTF-16 perhaps)",
           "Save the table as CSV in UTF-8.");
  CsvTable table;
  int line = 0;
  for (const std::string_view content : split(text, '\n')) {
    ++line;
    if (content.empty() || content.front() == '#') continue;
    if (table.header.cells.empty()) {
      if (const std::string used = other_separator(content); !used.empty())
        refuse("csv.separator"_rule, file, line,
               fmt::format("separates its columns by {}; commas are read", used),
               "Save the table with commas, and a point as the decimal sign.");
      table.header = row_of(content, line);
      continue;
    }
    CsvRow row = row_of(content, line);
    const std::size_t found = row.cells.size(), wanted = table.header.cells.size();
    if (found == wanted)
      table.rows.push_back(std::move(row));
    else
      table.problems.push_back({"csv.cells"_rule, "row", fmt::format("{} cells", found),
                                fmt::format("must have {}, as the header has", wanted),
                                "Add or remove commas; a number has a point as its decimal sign.", file,
                                line});
  }
  if (table.header.cells.empty())
    refuse("csv.empty"_rule, file, 0, "holds no table", "Write a header line and a line for each row.");
  return table;
}

CsvTable read_csv(const std::filesystem::path& path) {
  return parse_csv(read_text_file(path), path.string());
}

}  // namespace heddle
