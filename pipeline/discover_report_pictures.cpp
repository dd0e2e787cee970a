#include "pipeline/discover_report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace heddle::pipeline {

namespace {

std::array<Point, 4> box(double left, double top, double right, double bottom) {
  return {{{left, top}, {right, top}, {right, bottom}, {left, bottom}}};
}

std::string signed_fill(double share) {
  constexpr int middle = signed_styles / 2;
  const long step = std::lround(std::clamp(share, -1.0, 1.0) * middle);
  return fmt::format("d{}", middle + step);
}

std::string signed_percent(double share) {
  const double percent = 100.0 * share;
  if (std::abs(percent) < 0.05) return "0";
  return fmt::format("{}{:.{}f}", percent < 0.0 ? "−" : "+", std::abs(percent),
                     std::abs(percent) < 9.95 ? 1 : 0);
}

/// The bar of colours under a matrix, with what its ends mean.
void draw_signs(Canvas& canvas, double left, double top, double full) {
  constexpr double step = 13.0, height = 9.0;
  for (int k = 0; k < signed_styles; ++k)
    canvas.polygon(box(left + k * step, top, left + (k + 1) * step, top + height), fmt::format("d{}", k));
  const double right = left + signed_styles * step;
  canvas.text({left - 6, top + height}, fmt::format("model too high −{:.3g} %", 100.0 * full), Anchor::end,
              "faint");
  canvas.text({right + 6, top + height}, fmt::format("+{:.3g} % too low", 100.0 * full), Anchor::start,
              "faint");
}

double clear_step(const std::vector<double>& ticks) {
  return ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
}

}  // namespace

Canvas draw(const MatrixPicture& picture) {
  constexpr double left = 86.0, top = 46.0, row_height = 30.0;
  const double right = picture.width - 8.0;
  const double column =
      (right - left) / static_cast<double>(std::max<std::size_t>(picture.columns.size(), 1));
  const double bottom = top + row_height * static_cast<double>(picture.rows.size());
  Canvas canvas(picture.width, bottom + 76.0, picture.label);
  canvas.text({left, 18.0}, picture.down, Anchor::start, "title");
  canvas.text({right, bottom + 38.0}, picture.across, Anchor::end, "title");
  for (std::size_t i = 0; i < picture.columns.size(); ++i)
    canvas.text({left + column * (static_cast<double>(i) + 0.5), bottom + 18.0}, picture.columns[i],
                Anchor::middle, "faint");
  for (std::size_t j = 0; j < picture.rows.size(); ++j) {
    // Rows rise from below, as on an axis.
    const double low = bottom - row_height * static_cast<double>(j), middle = low - 0.5 * row_height;
    canvas.text({left - 8, middle + 4}, picture.rows[j], Anchor::end, "faint");
    for (std::size_t i = 0; i < picture.columns.size(); ++i) {
      const MatrixField& field = picture.fields[j * picture.columns.size() + i];
      const double x = left + column * static_cast<double>(i);
      if (field.cells == 0) {
        canvas.disc({x + 0.5 * column, middle}, 1.2, "bar");
        continue;
      }
      const bool within_noise = std::abs(field.value) < 1.96 * field.noise;
      const double share = (within_noise ? 0.4 : 1.0) * field.value / picture.full;
      canvas.polygon(box(x + 1, low - row_height + 1, x + column - 1, low - 1), signed_fill(share));
      canvas.text({x + 0.5 * column, middle + 4}, signed_percent(field.value), Anchor::middle,
                  within_noise ? "faint" : "title");
    }
  }
  draw_signs(canvas, left + 140.0, bottom + 57.0, picture.full);
  return canvas;
}

Canvas draw(const BarPicture& picture) {
  constexpr double row_height = 26.0, top = 40.0;
  const double left = picture.name_room, right = picture.width - picture.words_room;
  const double bottom = top + row_height * static_cast<double>(picture.bars.size());
  Canvas canvas(picture.width, bottom + 42.0, picture.label);
  double low = std::min(0.0, picture.mark), high = std::max(0.0, picture.mark);
  for (const Bar& bar : picture.bars) low = std::min(low, bar.length), high = std::max(high, bar.length);
  const std::vector<double> ticks = nice_ticks(low, high, 6);
  low = ticks.front();
  high = ticks.back();
  const auto at = [&](double value) { return left + (value - low) / (high - low) * (right - left); };
  for (const double tick : ticks) {
    canvas.line({at(tick), top}, {at(tick), bottom}, "grid");
    canvas.text({at(tick), bottom + 18.0}, tick_text(tick, clear_step(ticks)), Anchor::middle, "faint");
  }
  double row = top;
  for (const Bar& bar : picture.bars) {
    const double middle = row + 0.5 * row_height;
    canvas.text({left - 12, middle + 4}, bar.name, Anchor::end, bar.strong ? "title" : "label");
    const double from = std::min(at(0.0), at(bar.length)), to = std::max(at(0.0), at(bar.length));
    canvas.polygon(box(from, row + 5, std::max(to, from + 1.0), row + row_height - 5),
                   bar.strong ? "b6" : "bar");
    canvas.text({right + 14, middle + 4}, bar.words, Anchor::start, bar.strong ? "title" : "faint");
    row += row_height;
  }
  canvas.line({at(0.0), top}, {at(0.0), bottom}, "axis");
  canvas.line({at(picture.mark), top - 4}, {at(picture.mark), bottom}, "outline");
  canvas.text({at(picture.mark) + 5, top - 8}, picture.mark_words, Anchor::start, "faint");
  canvas.text({right, bottom + 36.0}, picture.quantity, Anchor::end, "faint");
  return canvas;
}

Canvas draw(const BeforeAfterPicture& picture) {
  // Names as long as they can be read; beyond that many conditions only their marks.
  const auto count = static_cast<double>(picture.rows.size());
  const double row_height = std::clamp(620.0 / std::max(count, 1.0), 2.5, 24.0);
  const bool named = row_height >= 13.0;
  const double left = named ? 430.0 : 20.0, right = picture.width - 20.0, top = 44.0;
  const double bottom = top + row_height * count;
  Canvas canvas(picture.width, bottom + 46.0, picture.label);
  double high = 0.0;
  for (const BeforeAfter& row : picture.rows) high = std::max({high, row.before, row.after, row.noise});
  const std::vector<double> ticks = nice_ticks(0.0, 100.0 * high, 8);
  const auto at = [&](double share) { return left + 100.0 * share / ticks.back() * (right - left); };
  double y = top;
  for (const BeforeAfter& row : picture.rows) {
    canvas.polygon(box(left, y, at(row.noise), y + row_height), "ribbon");
    y += row_height;
  }
  for (const double tick : ticks) {
    canvas.line({at(0.01 * tick), top}, {at(0.01 * tick), bottom}, "grid");
    canvas.text({at(0.01 * tick), bottom + 18.0}, tick_text(tick, clear_step(ticks)), Anchor::middle,
                "faint");
  }
  const double radius = std::clamp(0.22 * row_height, 1.2, 4.5);
  y = top + 0.5 * row_height;
  for (const BeforeAfter& row : picture.rows) {
    canvas.line({at(row.before), y}, {at(row.after), y}, "axis");
    canvas.disc({at(row.before), y}, radius, "hollow");
    canvas.disc({at(row.after), y}, radius, row.after <= row.before ? "dot s0" : "dot s1");
    if (named) canvas.text({left - 12, y + 4}, row.name, Anchor::end, "faint");
    y += row_height;
  }
  canvas.line({left, top}, {left, bottom}, "axis");
  canvas.disc({left + 6, 18.0}, 4.5, "hollow");
  canvas.text({left + 16, 22.0}, "before", Anchor::start, "label");
  canvas.disc({left + 86, 18.0}, 4.5, "dot s0");
  canvas.text({left + 96, 22.0}, "after", Anchor::start, "label");
  canvas.disc({left + 156, 18.0}, 4.5, "dot s1");
  canvas.text({left + 166, 22.0}, "after, further off", Anchor::start, "label");
  canvas.polygon(box(left + 288, 12.0, left + 308, 24.0), "ribbon");
  canvas.text({left + 315, 22.0}, "noise alone", Anchor::start, "label");
  canvas.text({right, bottom + 38.0},
              "Model off the measured force (% of it, root mean square over the pull)", Anchor::end, "faint");
  return canvas;
}

}  // namespace heddle::pipeline
