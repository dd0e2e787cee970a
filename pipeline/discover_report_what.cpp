#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/calibration_record.h"
#include "pipeline/chart.h"
#include "pipeline/discover_report_parts.h"
#include "pipeline/discover_report_pictures.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

using discover::Answer;
using discover::Scored;

std::string probability_text(double probability) {
  if (probability > 0.9995) return "> 0.999";
  if (probability < 0.0005) return "< 0.001";
  return fmt::format("{:.3f}", probability);
}

std::string ranking_figure(const DiscoveryPage& page) {
  BarPicture picture;
  picture.label = "ln Bayes factor against nothing missing, and probability, of the best explanations";
  picture.quantity = "ln Bayes factor against nothing missing";
  picture.mark = page.record.question.search.bayes_factor;
  picture.mark_words = "needed of a name";
  picture.width = full_width;
  for (const Scored& one : page.found.result.scored) {
    if (picture.bars.size() == 10) break;
    const bool given = page.named() && one.fit.hypothesis == page.found.decision.named;
    std::string name = page.name_of(one, " + ");
    // A wrong label names two conditions, too long for a bar: of several pairs only the best is shown.
    if (const std::size_t detail = name.find(" ("); detail != std::string::npos) name.erase(detail);
    if (std::ranges::count(picture.bars, name, &Bar::name) > 0) continue;
    picture.bars.push_back({std::move(name), one.fit.log_evidence - page.found.result.log_evidence_none,
                            fmt::format("probability {}", probability_text(one.probability)), given});
  }
  const std::size_t all = page.found.result.scored.size();
  return figure(
      draw(picture),
      fmt::format("The best {} of {} explanations tried. The length is how much better the data speak for it "
                  "than for nothing missing, its freedom paid for; the probability weighs in how many names "
                  "there are. An explanation of two effects must beat each of them alone.",
                  picture.bars.size(), all));
}

/// A number as fitted, with its 95 % interval and what was believed before.
struct NumberRow {
  std::string key, value, interval, prior;
};

std::vector<NumberRow> numbers_of(const DiscoveryPage& page, const discover::MapFit& fit) {
  std::vector<NumberRow> rows;
  Eigen::Index at = 0;
  for (const discover::Unknown& unknown : page.found.forward.baseline) at += unknown.prior.is_free() ? 1 : 0;
  for (const std::size_t effect : fit.hypothesis)
    for (const discover::Unknown& unknown : page.found.forward.candidates[effect].numbers) {
      if (!unknown.prior.is_free()) continue;
      const auto text = [&](double z) { return quantity_text(unknown.prior.value_at(z), unknown.unit, 3); };
      const auto [low, high] = unknown.prior.bounds();
      const double reach = 1.96 * std::sqrt(fit.covariance(at, at));
      rows.push_back({unknown.key, text(fit.z[at]),
                      fmt::format("{} to {}", text(std::max(fit.z[at] - reach, low)),
                                  text(std::min(fit.z[at] + reach, high))),
                      discover::write_prior(unknown.prior, unknown.unit)});
      ++at;
    }
  return rows;
}

std::string number_table(const DiscoveryPage& page) {
  const Scored* best = page.best();
  if (best == nullptr || page.found.decision.answer == Answer::no_gap) return "";
  std::vector<std::vector<std::string>> rows;
  for (const NumberRow& row : numbers_of(page, best->numbers))
    rows.push_back({row.key, row.value, row.interval, row.prior});
  if (rows.empty()) return "";
  std::string forms;
  for (const std::size_t effect : best->fit.hypothesis) {
    const discover::Candidate& candidate = page.found.forward.candidates[effect];
    forms += fmt::format("<p>{}: <code>{}</code>. {}.</p>\n", escape(spaced(candidate.id)),
                         escape(candidate.form), escape(candidate.source));
  }
  return fmt::format("<h3>Its numbers{}</h3>\n", page.named() ? "" : ", if the best name were right") +
         forms + table({"Number", "Value", "95 % interval", "Prior"}, rows);
}

// ---- fingerprints

Axis axis_of(const Levels& levels) {
  Axis axis{levels.capital(), levels.unit, levels.logarithmic ? Scale::logarithmic : Scale::linear};
  const double low = levels.at.front(), high = levels.at.back();
  // A logarithmic axis over less than a factor of five would have one tick or none.
  if (levels.logarithmic && high < 5.0 * low) axis.scale = Scale::linear;
  const bool log = axis.scale == Scale::logarithmic;
  axis.low = log ? low * std::pow(high / low, -0.05) : low - 0.05 * (high - low);
  axis.high = log ? high * std::pow(high / low, 0.05) : high + 0.05 * (high - low);
  return axis;
}

std::string cut_words(const DiscoveryPage& page, const Cut& cut) {
  return cut.at ? fmt::format("{}, at {}", page.levels[cut.along].name,
                              page.levels[cut.at->first].words(cut.at->second))
                : fmt::format("{}, all conditions", page.levels[cut.along].name);
}

Canvas fingerprint_chart(const DiscoveryPage& page, const Cut& cut, double width) {
  const Levels& along = page.levels[cut.along];
  LineChart chart;
  chart.x = axis_of(along);
  chart.y = {"Force over the baseline's, less 1", "%"};
  chart.width = width;
  chart.height = 320.0;
  chart.label_room = 178.0;
  chart.label =
      fmt::format("Measured gap and what the best explanations add, along {}", cut_words(page, cut));
  const std::vector<WeightedMean> measured = means_along(page.gap, page.levels, cut, page.gap.gap);
  Series dots{"measured", {}, {}, true};
  Ribbon noise;
  for (std::size_t level = 0; level < along.count(); ++level) {
    if (measured[level].cells == 0) continue;
    const double reach = 1.96 * measured[level].noise;
    dots.x.push_back(along.at[level]);
    dots.y.push_back(100.0 * std::expm1(measured[level].value));
    noise.x.push_back(along.at[level]);
    noise.low.push_back(100.0 * std::expm1(measured[level].value - reach));
    noise.high.push_back(100.0 * std::expm1(measured[level].value + reach));
  }
  const std::vector<double> at = dots.x;
  chart.ribbons.push_back(std::move(noise));
  chart.series.push_back(std::move(dots));
  for (const Scored* rival : page.rivals) {
    const std::vector<WeightedMean> means =
        means_along(page.gap, page.levels, cut, added_by(page.gap, *rival));
    std::string name = page.name_of(*rival, " + ");
    if (const std::size_t detail = name.find(" ("); detail != std::string::npos) name.erase(detail);
    if (name.size() > 24) name = name.substr(0, 22) + "…";  // the whole name is under the picture
    Series line{std::move(name), at, {}};
    for (const WeightedMean& mean : means)
      if (mean.cells > 0) line.y.push_back(100.0 * std::expm1(mean.value));
    chart.series.push_back(std::move(line));
  }
  return draw(chart);
}

std::string fingerprints(const DiscoveryPage& page) {
  if (page.rivals.empty() || page.levels.empty()) return "";
  const Eigen::VectorXd best = added_by(page.gap, *page.rivals[0]);
  const auto acts = cut_between(page.gap, page.levels, best, Eigen::VectorXd::Zero(best.size()));
  if (!acts) return "";
  const auto apart = page.rivals.size() > 1
                         ? cut_between(page.gap, page.levels, best, added_by(page.gap, *page.rivals[1]))
                         : std::nullopt;
  const bool two = apart && (apart->along != acts->along || apart->at != acts->at);
  const std::string name = page.name_of(*page.rivals[0], " + ");
  const std::string words =
      "<h3>Fingerprints</h3>\n<p>The measured gap, and what each of the best explanations adds to the "
      "baseline. The right "
      "one follows the dots everywhere; a look-alike leaves them somewhere. The band is the noise of the "
      "measured means (95 "
      "%).</p>\n";
  const std::string first = fmt::format("Where {} does most, along {}.", name, cut_words(page, *acts));
  if (!apart) return words + figure(fingerprint_chart(page, *acts, full_width), first);
  const std::string second = fmt::format(
      "{} {} and {} differ most, {:.1f} standard deviations of noise{}.", two ? "Where" : "There also", name,
      page.name_of(*page.rivals[1], " + "), std::sqrt(apart->separation),
      two ? fmt::format(", along {}", cut_words(page, *apart)) : std::string());
  if (!two) return words + figure(fingerprint_chart(page, *acts, full_width), first + " " + second);
  return words + pair(figure(fingerprint_chart(page, *acts, half_width), first),
                      figure(fingerprint_chart(page, *apart, half_width), second));
}

// ---- a gap without a name

/// A shape over two coordinates as a matrix, one over a single one as a curve.
Canvas shape_matrix(const DiscoveryPage& page, const discover::Shape& shape, const Levels& x,
                    const Levels& y) {
  MatrixPicture picture;
  picture.label = fmt::format("Smooth gap over {} and {}, in per cent of the force", x.name, y.name);
  picture.across = x.title();
  picture.down = y.title();
  picture.columns = x.text;
  picture.rows = y.text;
  picture.width = full_width;
  double largest = 0.01;
  for (std::size_t row = 0; row < y.count(); ++row)
    for (std::size_t column = 0; column < x.count(); ++column) {
      const Eigen::VectorXd weights = weights_of(
          page.gap, "whole pull", [&](std::size_t i) { return x.of[i] == column && y.of[i] == row; });
      // The shape's own band takes the place of noise: it is known no better than that.
      picture.fields.push_back(
          {shape.mean.dot(weights), shape.sd.dot(weights), mean_of(page.gap, shape.mean, weights).cells});
      largest = std::max(largest, std::abs(picture.fields.back().value));
    }
  picture.full = 0.01 * std::ceil(100.0 * largest);
  return draw(picture);
}

Canvas shape_curve(const DiscoveryPage& page, const discover::Shape& shape) {
  LineChart chart;
  const std::vector<discover::ShapePoint> curve = curve_of(shape, page.found.training);
  const auto levels = std::ranges::find(page.levels, spaced(shape.over), &Levels::name);
  if (levels != page.levels.end())
    chart.x = axis_of(*levels);
  else
    chart.x = {"Slip", "mm", Scale::logarithmic};
  chart.y = {"Measured force over the model's, less 1", "%"};
  chart.label = fmt::format("Smooth gap over {}", spaced(shape.over));
  chart.width = full_width;
  chart.height = 320.0;
  Series line;
  Ribbon band;
  for (const discover::ShapePoint& point : curve) {
    line.x.push_back(point.at);
    line.y.push_back(100.0 * std::expm1(point.gap));
    band.x.push_back(point.at);
    band.low.push_back(100.0 * std::expm1(point.low));
    band.high.push_back(100.0 * std::expm1(point.high));
  }
  chart.series.push_back(std::move(line));
  chart.ribbons.push_back(std::move(band));
  return draw(chart);
}

std::string shape_figure(const DiscoveryPage& page, const std::vector<discover::Shape>& shapes,
                         std::string_view what) {
  if (shapes.empty()) return "";
  const discover::Shape& shape = shapes.front();
  const std::string over = spaced(shape.over);
  const std::size_t cross = over.find(" x ");
  const auto levels_named = [&](const std::string& name) {
    return std::ranges::find(page.levels, name, &Levels::name);
  };
  const auto x = levels_named(over.substr(0, cross));
  const auto y = cross == std::string::npos ? page.levels.end() : levels_named(over.substr(cross + 3));
  const bool is_matrix = x != page.levels.end() && y != page.levels.end();
  const double largest = shape.mean.cwiseAbs().maxCoeff();
  return fmt::format("<h3>{}</h3>\n", what) +
         figure(
             is_matrix ? shape_matrix(page, shape, *x, *y) : shape_curve(page, shape),
             fmt::format(
                 "A smooth gap over {}, ln Bayes factor {:.1f}, up to {:.1f} % of the force. {}shape.csv has "
                 "its "
                 "points. It holds between the conditions that were measured and says nothing beyond them.",
                 over, shape.log_evidence, 100.0 * largest,
                 is_matrix ? "Bold: beyond its 95 % band. "
                           : "The band (95 %) holds the level too, which the baseline could take up. "));
}

std::string shape_part(const DiscoveryPage& page) {
  if (page.found.decision.answer == Answer::unknown)
    return shape_figure(page, page.found.evidence.gap_shapes, "The shape that has no name");
  if (page.found.decision.answer == Answer::named_incomplete)
    return shape_figure(page, page.found.evidence.rest_shapes, "What the name leaves over");
  return "";
}

}  // namespace

std::string what_section(const DiscoveryPage& page) {
  if (page.found.decision.answer == Answer::no_gap) return section("What was tried", ranking_figure(page));
  return section("What it is",
                 shape_part(page) + ranking_figure(page) + number_table(page) + fingerprints(page));
}

}  // namespace heddle::pipeline
