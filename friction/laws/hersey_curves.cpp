#include "friction/laws/hersey_curves.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "core/csv.h"
#include "core/problem.h"
#include "core/text_file.h"

namespace heddle::friction {

namespace {

/// exp(-(Hs/Hc)^k): the share of the boundary branch; and (Hs/Hc)^k.
struct Boundary {
  double share, exponent;
};
Boundary boundary_of(const StribeckCurve& law, double hersey) {
  const double exponent = std::pow(hersey / law.transition, law.sharpness);
  return {std::exp(-exponent), exponent};
}

}  // namespace

Regime regime(const StribeckCurve& law, double hersey) {
  const double share = boundary_of(law, hersey).share;
  if (share > 0.9) return Regime::boundary;
  return share < 0.1 ? Regime::hydrodynamic : Regime::mixed;
}

LawValue curve_value(const StribeckCurve& law, double hersey) {
  const auto [share, exponent] = boundary_of(law, hersey);
  const double rise = law.slope * hersey / law.reference;
  const double above = law.boundary - (law.offset + rise);
  // Far beyond the transition the exponent is huge and the share nothing: their product is nothing, not NaN.
  const double fall = share > 0.0 ? above * share * law.sharpness * exponent : 0.0;
  return {.mu = law.offset + rise + above * share, .dmu_dlog_hersey = rise * (1.0 - share) - fall};
}

LawValue curve_value(const FilmSolid& law, double hersey) {
  const double film = law.wetted_share * hersey;
  return {.mu = law.solid + film, .dmu_dlog_hersey = film};
}

LawValue curve_value(const HerseyTable& law, double hersey) {
  const Curve::Value at = law.curve.evaluate(std::log(hersey));
  return {.mu = at.y, .dmu_dlog_hersey = at.slope};
}

HerseyTable hersey_table(std::vector<double> hersey, std::vector<double> coefficient) {
  Problems problems;
  const auto report = [&](const RuleId& id, std::string value, std::string rule, const char* way_out) {
    problems.push_back({.id = id,
                        .key = "friction.table",
                        .value = std::move(value),
                        .rule = std::move(rule),
                        .way_out = way_out});
  };
  if (hersey.size() != coefficient.size() || hersey.size() < 2)
    report("friction.hersey_table.size"_rule,
           fmt::format("{} Hersey numbers, {} coefficients", hersey.size(), coefficient.size()),
           "must hold at least two pairs", "One line a pair.");
  for (std::size_t i = 0; i < hersey.size(); ++i) {
    if (!(hersey[i] > 0.0 && std::isfinite(hersey[i])))
      report("friction.hersey_table.hersey.range"_rule, fmt::format("{} (pair {})", hersey[i], i + 1),
             "must satisfy 0 < Hs", "The curve runs over ln Hs; leave the point at rest out.");
    else if (i > 0 && !(hersey[i] > hersey[i - 1]))
      report("friction.hersey_table.hersey.order"_rule,
             fmt::format("{} after {} (pair {})", hersey[i], hersey[i - 1], i + 1),
             "must rise strictly from pair to pair", "Sort the table by Hs and merge equal ones.");
  }
  for (std::size_t i = 0; i < coefficient.size(); ++i)
    if (!(coefficient[i] > 0.0 && coefficient[i] < 10.0))
      report("friction.hersey_table.coefficient.range"_rule,
             fmt::format("{} (pair {})", coefficient[i], i + 1), "must satisfy 0 < mu < 10",
             "Beyond the table its log slope is held, which asks for mu above 0.");
  if (!problems.empty()) throw InputError(std::move(problems));

  std::vector<double> log_hersey;
  for (const double h : hersey) log_hersey.push_back(std::log(h));
  Curve curve(std::move(log_hersey), coefficient);
  return {.hersey = std::move(hersey), .coefficient = std::move(coefficient), .curve = std::move(curve)};
}

HerseyTable read_hersey_table(const std::string& path) {
  const CsvTable table = parse_csv(read_text_file(path), path);
  Problems problems = table.problems;
  const auto column = [&](const char* name) -> std::optional<std::size_t> {
    for (std::size_t c = 0; c < table.header.cells.size(); ++c)
      if (table.header.cells[c] == name) return c;
    problems.push_back({"friction.hersey_table.column"_rule, name, "", "must be a column",
                        "Name it in the header line.", path, table.header.line});
    return {};
  };
  const auto hersey_column = column("hersey_number"), mu_column = column("friction_coefficient");
  std::vector<double> hersey, mu;
  const auto read = [&](const CsvRow& row, std::size_t at, std::vector<double>& into) {
    const std::string& cell = row.cells[at];
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    // from_chars takes "nan" and "inf" as numbers.
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
      problems.push_back({"friction.hersey_table.number"_rule, table.header.cells[at], cell,
                          "must be a finite number", "Correct the cell, or leave its line out.", path,
                          row.line});
    into.push_back(value);
  };
  if (problems.empty())
    for (const CsvRow& row : table.rows) {
      read(row, *hersey_column, hersey);
      read(row, *mu_column, mu);
    }
  if (!problems.empty()) throw InputError(std::move(problems));
  try {
    return hersey_table(std::move(hersey), std::move(mu));
  } catch (const InputError& error) {
    problems = error.problems();
    for (Problem& problem : problems) problem.file = path;
    throw InputError(std::move(problems));
  }
}

}  // namespace heddle::friction
