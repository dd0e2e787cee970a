#include "pipeline/page.h"

#include <fmt/format.h>

#include "pipeline/report_style.h"

namespace heddle::pipeline {

namespace {

struct ToneWords {
  std::string_view style, word;
};

ToneWords words(Tone tone) {
  switch (tone) {
    case Tone::holds:
      return {"holds", "✓ holds"};
    case Tone::note:
      return {"note", "· note"};
    case Tone::attention:
      return {"attention", "! attention"};
    case Tone::fails:
      return {"fails", "✗ fails"};
  }
  return {"fails", "✗ fails"};
}

}  // namespace

std::string page_head(std::string_view title) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{} · "
      "heddle</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n",
      escape(title), report_style());
}

std::string page_foot(std::string_view words) {
  return fmt::format("<footer>{}</footer>\n</main>\n</body>\n</html>\n", escape(words));
}

std::string result(std::string_view name, const std::string& value, std::string_view unit) {
  return fmt::format("<div><dt>{}</dt><dd>{}<small>{}{}</small></dd></div>\n", escape(name), escape(value),
                     unit == "°" ? "" : "\u2009", escape(unit));
}

std::string results(const std::string& tiles) {
  return tiles.empty() ? "" : "<dl class=\"results\">\n" + tiles + "</dl>\n";
}

std::string section(std::string_view title, const std::string& body) {
  return body.empty() ? "" : fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", escape(title), body);
}

std::string figure(const Canvas& picture, std::string_view caption) {
  return fmt::format("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", picture.inline_svg(),
                     escape(caption));
}

std::string pair(const std::string& left, const std::string& right) {
  return left.empty() && right.empty() ? "" : "<div class=\"pair\">\n" + left + right + "</div>\n";
}

std::string pairs(const std::vector<std::string>& figures) {
  std::string out;
  for (std::size_t k = 0; k < figures.size(); k += 2)
    out += pair(figures[k], k + 1 < figures.size() ? figures[k + 1] : "");
  return out;
}

std::string facts_table(const std::vector<Condition>& facts) {
  if (facts.empty()) return "";
  std::string out = "<table class=\"facts\">\n";
  for (const Condition& fact : facts) {
    out += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escape(fact.name), escape(fact.value));
  }
  return out + "</table>\n";
}

std::string list(const std::vector<std::string>& texts) {
  if (texts.empty()) return "";
  std::string out = "<ul class=\"notes\">\n";
  for (const std::string& text : texts) out += fmt::format("<li>{}</li>\n", escape(text));
  return out + "</ul>\n";
}

std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"scroll\"><table>\n<tr>";
  for (std::size_t k = 0; k < head.size(); ++k)
    out += fmt::format("<th{}>{}</th>", k > 0 ? " class=\"number\"" : "", escape(head[k]));
  out += "</tr>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      out += fmt::format("<td{}>{}</td>", k > 0 ? " class=\"number\"" : "", escape(row[k]));
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string verdict_list(const std::vector<Verdict>& verdicts) {
  std::string out;
  for (const Verdict& verdict : verdicts) {
    const ToneWords tone = words(verdict.tone);
    out += fmt::format("<li class=\"{}\"><span class=\"tone\">{}</span><span>{}</span></li>\n", tone.style,
                       tone.word, escape(verdict.text));
  }
  return out.empty() ? "" : "<ul class=\"verdicts\">\n" + out + "</ul>\n";
}

}  // namespace heddle::pipeline
