#include "pipeline/stack_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/chart.h"
#include "pipeline/page.h"
#include "pipeline/picture.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

double at(const mesoscale::NestingMap& map, int i, int j) {
  return map
      .thickness[static_cast<std::size_t>(j) * static_cast<std::size_t>(map.n) + static_cast<std::size_t>(i)];
}

Canvas cut_picture(const StackView& view) {
  SectionPicture picture;
  picture.label = "Section through the stack along a warp";
  picture.along = "Along the warp";
  for (const mesoscale::Outline& outline : view.cut)
    picture.lines.push_back(
        {outline.tow == mesoscale::TowDirection::warp ? SectionKind::warp : SectionKind::weft,
         outline.points});
  return draw(picture);
}

Canvas map_picture(const StackView& view) {
  const mesoscale::NestingMap& map = view.nesting;
  GridPicture picture;
  picture.label = "Thickness of two plies over the shift of the upper one";
  picture.nx = picture.ny = map.n;
  picture.spacing_x = map.step[0];
  picture.spacing_y = map.step[1];
  for (const double thickness : map.thickness) picture.value.push_back(1e3 * thickness);
  const auto [low, high] = std::minmax_element(picture.value.begin(), picture.value.end());
  picture.colours = {*low, *high, "Two plies", "mm"};
  picture.width = half_width;
  return draw(picture);
}

Canvas glass_chart(const StackView& view) {
  const mesoscale::NestingMap& map = view.nesting;
  LineChart chart;
  chart.label = "Glass of two plies by volume over the shift of the upper one";
  chart.x = {"Shift over the repeat", "%", Scale::linear, 0.0, 100.0};
  chart.y = {"Glass by volume", "%"};
  // Shifted by the whole repeat a ply lies as it did.
  Series warp{"along warp", {}, {}}, weft{"along weft", {}, {}}, both{"along both", {}, {}};
  for (int k = 0; k <= map.n; ++k) {
    const auto add = [&](Series& series, int i, int j) {
      series.x.push_back(100.0 * k / map.n);
      series.y.push_back(100.0 * view.glass_of_two / at(map, i % map.n, j % map.n));
    };
    add(warp, k, 0);
    add(weft, 0, k);
    add(both, k, k);
  }
  chart.series = {warp, weft, both};
  chart.width = half_width;
  chart.height = 340.0;
  chart.label_room = 90.0;
  return draw(chart);
}

std::vector<Condition> facts(const mesoscale::StackSummary& s) {
  const auto percent = [](double share) { return significant(100.0 * std::max(share, 0.0), 3) + " %"; };
  std::vector<Condition> rows{
      {"Plies", std::to_string(s.plies)},
      {"Thickness", significant(1e3 * s.thickness, 4) + " mm"},
      {"Crowns on crowns it would be", significant(1e3 * s.apart, 4) + " mm"},
      {"Of the stack: tows with their voids; glass; all voids",
       fmt::format("{}, {}, {}", percent(s.shares.tows), percent(s.shares.glass), percent(s.shares.voids))}};
  if (s.swelling > 1.0 + 1e-9)
    rows.push_back({"Tows thicker than in the lone ply", percent(s.swelling - 1.0)});
  return rows;
}

}  // namespace

StackView stack_view(const mesoscale::CellSpec& spec) {
  const mesoscale::FabricGeometry fabric = mesoscale::fabric_geometry(spec);
  const mesoscale::StackedFabric stack = mesoscale::stacked(spec);
  StackView view;
  view.summary = mesoscale::summary_of(stack, fabric.thickness);
  view.cut = mesoscale::stack_cut(stack.stack);
  // The cost of one shift grows with the square of the tows.
  const int tows = std::max(fabric.weave.warps, fabric.weave.wefts);
  view.nesting = mesoscale::nesting_map(mesoscale::unit_cell(fabric, 0.0), tows <= 2   ? 48
                                                                           : tows <= 8 ? 24
                                                                                       : 12);
  view.glass_of_two = 2.0 * mesoscale::sheet_shares(fabric).glass * fabric.thickness;
  view.consolidated = spec.state == mesoscale::CellState::consolidated;
  return view;
}

std::string nesting_csv(const StackView& view) {
  const mesoscale::NestingMap& map = view.nesting;
  std::string text = "shift_warp_mm,shift_weft_mm,thickness_mm,glass_share\n";
  for (int j = 0; j < map.n; ++j)
    for (int i = 0; i < map.n; ++i)
      text += fmt::format("{},{},{},{}\n", 1e3 * i * map.step[0], 1e3 * j * map.step[1], 1e3 * at(map, i, j),
                          view.glass_of_two / at(map, i, j));
  return text;
}

std::string stack_section(const StackView& view) {
  const std::string state =
      view.consolidated ? " The consolidated stack is as thick as its glass and resin in any case; what "
                          "nesting gives back goes to the tows, which are thicker than in the lone ply."
                        : "";
  return figure(cut_picture(view),
                "Section through the stack along a warp of its lowest ply, at true proportions. Plies sink "
                "into each other until tows touch." +
                    state) +
         pair(figure(map_picture(view),
                     "How thick two plies are together, over the shift of the upper one along warp (right) "
                     "and weft (up), one repeat each way. Light: crowns meet crowns; dark: they nest."),
              figure(glass_chart(view), "What nesting does to the glass content of two plies.")) +
         facts_table(facts(view.summary));
}

}  // namespace heddle::pipeline
