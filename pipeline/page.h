#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipeline/painter.h"
#include "pipeline/report.h"

/// Pieces of the HTML pages that runs, studies and calibrations leave behind. Text is escaped here, once.
namespace heddle::pipeline {

/// From <!doctype html> to <main>, with the style; closed by page_foot.
std::string page_head(std::string_view title);
std::string page_foot(std::string_view words);

/// One large number at the top of a page; `results` holds several. Empty where the tiles are.
std::string result(std::string_view name, const std::string& value, std::string_view unit);
std::string results(const std::string& tiles);
/// Empty where the body is.
std::string section(std::string_view title, const std::string& body);
/// @param caption  says what to see in the picture
std::string figure(const Canvas& picture, std::string_view caption);
/// Two figures side by side.
std::string pair(const std::string& left, const std::string& right);
/// Figures two by two.
std::string pairs(const std::vector<std::string>& figures);
std::string facts_table(const std::vector<Condition>& facts);
std::string list(const std::vector<std::string>& texts);
/// First column text, the others numbers.
std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);
std::string verdict_list(const std::vector<Verdict>& verdicts);

}  // namespace heddle::pipeline
