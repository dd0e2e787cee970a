#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/problem.h"

namespace heddle {

/// One line of a table with its place in the file.
struct CsvRow {
  int line = 0;  ///< 1-based
  std::vector<std::string> cells;
};

/// A table of text: commas between cells, one header, as many cells in every row. Blanks round a cell, empty
/// lines, lines that start with #, carriage returns and a byte order mark are passed over.
struct CsvTable {
  CsvRow header;
  std::vector<CsvRow> rows;
  Problems problems;  ///< rows left out because they have more or fewer cells than the header (csv.cells):
                      ///< the reader adds what it finds in the others, so that all is said at once
};

/// @param file  named in problems
/// @throws InputError  where no table can be read at all: csv.empty, csv.encoding, csv.separator
CsvTable parse_csv(std::string_view text, const std::string& file);

/// @throws InputError  as parse_csv and read_text_file
CsvTable read_csv(const std::filesystem::path& path);

}  // namespace heddle
