#include "pipeline/stamping_keys.h"

#include "pipeline/key_table.h"

namespace heddle::pipeline {
// A table reads better in rows than one field a line.
// clang-format off
std::vector<Key> process_keys() {
  const auto stamping = Stage::stamping;
  return {
      {.path = "process.punch.stroke", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 10000 mm)", .stage = stamping, .used_when = "!process.punch.file",
       .help = "Travel of the punch from first touch."},
      {.path = "process.punch.time", .type = KeyType::quantity, .unit = "s", .presence = required, .range = "(0 s, )",
       .stage = stamping, .used_when = "!process.punch.file", .help = "Of the stroke at speed_scale 1."},
      {.path = "process.punch.speed_scale", .type = KeyType::quantity, .presence = defaulted, .default_text = "1",
       .range = "(0, )", .stage = stamping, .help = "0.5: half the speed."},
      {.path = "process.punch.slow_down", .type = KeyType::quantity, .unit = "s", .presence = defaulted,
       .default_text = "0 s", .range = "[0 s, )", .stage = stamping, .used_when = "!process.punch.file",
       .help = "The punch stops linearly over this last part; 0.01 s in the paper (section 3.2.2)."},
      {.path = "process.punch.file", .type = KeyType::file, .presence = optional, .stage = stamping,
       .help = "Motion of the punch instead: columns time_s and punch_displacement_mm, from 0 s and 0 mm on."},
      {.path = "process.steps", .type = KeyType::integer, .presence = defaulted, .default_text = "100",
       .range = "[1, 1000000]", .stage = stamping, .help = "Equal in stroke; one that fails is halved."},
      {.path = "process.binder_force", .type = KeyType::quantity, .unit = "N", .presence = required,
       .range = "(0 N, )", .stage = stamping, .used_when = "tools.binder.control=force",
       .help = "Total force of the press on the binder (paper: 650 to 3000 N)."},
      {.path = "process.bottoming_force", .type = KeyType::quantity, .unit = "N", .presence = optional,
       .range = "(0 N, )", .stage = stamping,
       .help = "The punch yields where it would have to push harder than this, and goes on when it can."},
      {.path = "process.tool_temperature", .type = KeyType::quantity, .unit = "degC", .presence = required,
       .range = "[-100 degC, 500 degC]", .stage = stamping, .help = "Of punch, die and binder."},
      {.path = "process.blank_temperature", .type = KeyType::quantity, .unit = "degC", .presence = required,
       .range = "[-100 degC, 500 degC]", .stage = stamping, .help = "Of the fabric."},
      {.path = "process.gravity", .type = KeyType::choice, .presence = defaulted, .default_text = "off",
       .choices = {"on", "off"}, .stage = stamping,
       .help = "on: the fabric weighs what it is (the true mass) and sags before the punch moves; the binder's weight comes on top of binder_force."},
      {.path = "process.dwell", .type = KeyType::quantity, .unit = "s", .presence = defaulted, .default_text = "0 s",
       .range = "[0 s, 36000 s]", .stage = stamping,
       .help = "Time that the tools stand still after the stroke while fabric, resin and friction go on: 20 more rows of history.csv."},
      {.path = "process.hold", .type = KeyType::quantity, .unit = "s", .presence = defaulted, .default_text = "0 s",
       .range = "[0 s, 36000 s]", .stage = stamping, .used_when = "thermal",
       .help = "Longest time that the tools stay closed and still after the stroke (and after process.dwell); the fabric no longer moves, and it ends when no melt is left."},
      {.path = "process.release", .type = KeyType::choice, .presence = defaulted, .default_text = "off",
       .choices = {"on", "off"}, .stage = stamping,
       .help = "on: after all, punch and binder go up and the blank comes to rest on the die as its laws let it; the last frame is then the released blank."},
  };
}

std::vector<Key> press_effect_keys() {
  const auto stamping = Stage::stamping;
  const std::string offset = "effects.punch_misalignment", tilt = "effects.binder_tilt";
  return {
      {.path = "effects.press_compliance.compliance", .type = KeyType::quantity, .unit = "mm/kN", .presence = required,
       .range = "[0 mm/kN, 1000 mm/kN]", .stage = stamping, .used_when = "effects.press_compliance",
       .help = "Of the press: the punch stays behind its drive by this times its force; 0 mm/kN is off."},
      {.path = offset + ".offset", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "[-100 mm, 100 mm]", .stage = stamping, .used_when = offset,
       .help = "Of the punch's axis from that of die and binder; 0 mm is off."},
      {.path = offset + ".direction", .type = KeyType::quantity, .unit = "deg", .presence = defaulted,
       .default_text = "0 deg", .range = "[-360 deg, 360 deg]", .stage = stamping, .used_when = offset,
       .help = "In which the punch stands off, against x."},
      {.path = tilt + ".angle", .type = KeyType::quantity, .unit = "deg", .presence = required,
       .range = "[-5 deg, 5 deg]", .stage = stamping, .used_when = tilt,
       .help = "By which the binder is held out of level, about an axis through the punch's; 0 deg is off."},
      {.path = tilt + ".axis", .type = KeyType::quantity, .unit = "deg", .presence = defaulted, .default_text = "0 deg",
       .range = "[-360 deg, 360 deg]", .stage = stamping, .used_when = tilt,
       .help = "Direction of that axis against x; the side to its left goes up."},
  };
}

std::vector<Key> blank_keys() {
  const auto stamping = Stage::stamping;
  return {
      {.path = "blank.shape", .type = KeyType::choice, .presence = defaulted, .default_text = "rectangle",
       .choices = {"rectangle", "circle", "polygon", "drawing"}, .stage = stamping,
       .help = "Outline of the blank; the grid follows the tows and is trimmed to it."},
      {.path = "blank.size", .type = KeyType::pair, .unit = "mm", .presence = required, .range = "(0 mm, 100000 mm)",
       .stage = stamping, .used_when = "blank.shape=rectangle", .help = "Along x and y, centred on the punch axis."},
      {.path = "blank.radius", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 100000 mm)", .stage = stamping, .used_when = "blank.shape=circle",
       .help = "Of a round blank about the punch axis."},
      {.path = "blank.points", .type = KeyType::rows, .unit = "mm", .presence = required,
       .range = "[-100000 mm, 100000 mm]", .columns = 2, .stage = stamping, .used_when = "blank.shape=polygon",
       .help = "Corners [x, y] in order along the edge, at least three, for instance "
               "[[-160 mm, -160 mm], [160 mm, -160 mm], [0 mm, 200 mm]]."},
      {.path = "blank.drawing.file", .type = KeyType::file, .presence = required, .stage = stamping,
       .used_when = "blank.shape=drawing",
       .help = "DXF (text) or STEP with one plane face; the largest ring is the edge, all others are holes."},
      {.path = "blank.drawing.length_unit", .type = KeyType::choice, .presence = required,
       .choices = {"mm", "cm", "m", "in"}, .stage = stamping, .used_when = "blank.shape=drawing",
       .help = "Of the drawing's numbers; a unit that the drawing states must be the same."},
      {.path = "blank.drawing.chord_error", .type = KeyType::quantity, .unit = "mm", .presence = defaulted,
       .default_text = "0.01 mm", .range = "(0 mm, 10 mm]", .stage = stamping, .used_when = "blank.shape=drawing",
       .help = "Arcs become chords that stay this near to them."},
      {.path = "blank.holes", .type = KeyType::rows, .unit = "mm", .presence = optional,
       .range = "[-100000 mm, 100000 mm]", .columns = 3, .stage = stamping,
       .help = "Round holes [x, y, radius], for instance [[0 mm, 120 mm, 8 mm]]."},
      {.path = "blank.orientation", .type = KeyType::quantity, .unit = "deg", .presence = defaulted,
       .default_text = "0 deg", .range = "[-180 deg, 180 deg]", .stage = stamping, .help = "Warp against x."},
      {.path = "blank.spacing", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 1000 mm)", .stage = stamping,
       .help = "Upper bound of the node spacing; the size is divided into whole cells."},
      {.path = "blank.plies", .type = KeyType::integer, .presence = defaulted, .default_text = "1", .range = "[1, 16]",
       .stage = stamping, .help = "Of one fabric, on one another; each has a grid of its own, and they slip past each other."},
      {.path = "blank.layup", .type = KeyType::list, .unit = "deg", .presence = optional, .range = "[-180 deg, 180 deg]",
       .stage = stamping, .help = "Warp of each ply against blank.orientation, bottom first, for instance [0 deg, 45 deg, -45 deg, 90 deg]; absent: all alike."},
      {.path = "blank.nesting", .type = KeyType::quantity, .unit = "mm", .presence = defaulted, .default_text = "0 mm",
       .range = "[0 mm, 10 mm]", .stage = stamping,
       .help = "How much nearer than a thickness two plies lie before they press each other; `heddle weave` with `cell.plies: 2` says what a shift gives."},
      {.path = "blank.symmetry", .type = KeyType::choice, .presence = defaulted, .default_text = "none",
       .choices = {"none", "half_x", "half_y", "quarter"}, .stage = stamping,
       .help = "Piece of a symmetric part that is computed: the half at x >= 0, at y >= 0, or the quarter of both. "
               "Forces, energies and frames are those of the whole."},
      {.path = "blank.grid_error", .type = KeyType::choice, .presence = defaulted, .default_text = "on",
       .choices = {"on", "off"}, .stage = Stage::grid_error,
       .help = "on: the case is run once more on twice the spacing, for the error that the grid leaves in force, "
               "angle and draw-in; a sixth of the run's time."},
  };
}

std::vector<Key> contact_keys() {
  const auto stamping = Stage::stamping;
  return {
      {.path = "contact.points", .type = KeyType::choice, .presence = defaulted, .default_text = "nodes",
       .choices = {"nodes", "gauss"}, .stage = stamping,
       .help = "Where contact and friction are asked for: at the nodes with their tributary area, or at 2 x 2 Gauss points of each cell."},
      {.path = "contact.compaction", .type = KeyType::choice, .presence = defaulted, .default_text = "flat",
       .choices = {"flat", "sheared"}, .stage = stamping,
       .help = "flat: every place is pressed as the fabric that is not sheared; sheared: the pressure over thickness follows the trellis angle, on the area of the sheared fabric."},
      {.path = "contact.self", .type = KeyType::choice, .presence = defaulted, .default_text = "folds",
       .choices = {"folds", "off"}, .stage = stamping,
       .help = "folds: where a ply folds on itself its parts press and rub each other as plies do; off: they pass through each other."},
  };
}

namespace {

Key tool_friction_key(const std::string& tool) {
  return {.path = "tools." + tool + ".friction_coefficient", .type = KeyType::quantity, .presence = optional,
          .range = "[0, 10)", .stage = Stage::stamping,
          .help = "Constant mu on this tool, in place of the law and its effects; 0: frictionless. Absent: the law."};
}

// A tool by its file instead of by its shape: a key is then used by the shape or by the file, never by both.

std::vector<Key> tool_file_keys(const std::string& tool) {
  const std::string block = "tools." + tool, with_file = block + ".file";
  const auto stamping = Stage::stamping;
  return {
      {.path = with_file, .type = KeyType::file, .presence = optional, .stage = stamping,
       .help = "STEP, STL or OBJ instead of a shape; z up, x and y as in the press, moved along z until it touches."},
      {.path = block + ".length_unit", .type = KeyType::choice, .presence = required,
       .choices = {"mm", "cm", "m", "in"}, .stage = stamping, .used_when = with_file,
       .help = "Of the file's numbers; a STEP file states its own, which must be the same."},
      {.path = block + ".mesh_size", .type = KeyType::quantity, .unit = "mm", .presence = defaulted,
       .default_text = "2 mm", .range = "(0 mm, 1000 mm)", .stage = stamping, .used_when = with_file,
       .help = "Largest edge on curved faces of a STEP file."},
      {.path = block + ".chord_error", .type = KeyType::quantity, .unit = "mm", .presence = defaulted,
       .default_text = "0.05 mm", .range = "(0 mm, 10 mm)", .stage = stamping, .used_when = with_file,
       .help = "Triangles stay this near to the curved faces of a STEP file; edges follow the smallest radius of a face."},
      {.path = block + ".voxel", .type = KeyType::quantity, .unit = "mm", .presence = defaulted,
       .default_text = "1 mm", .range = "(0 mm, 100 mm)", .stage = stamping, .used_when = with_file,
       .help = "Of the distance field; a twentieth of the radii that matter keeps its error small."},
      {.path = block + ".sheet", .type = KeyType::choice, .presence = defaulted, .default_text = "off",
       .choices = {"on", "off"}, .stage = stamping, .used_when = with_file,
       .help = "on: a surface with a border instead of a solid; it must reach beyond whatever it is to meet."},
      {.path = block + ".repair", .type = KeyType::choice, .presence = defaulted, .default_text = "off",
       .choices = {"on", "off"}, .stage = stamping, .used_when = with_file,
       .help = "on: merge equal vertices, drop triangles without area, turn those that face the wrong way."},
  };
}

}  // namespace

std::vector<Key> tool_keys() {
  const auto stamping = Stage::stamping;
  std::vector<Key> keys{
      {.path = "tools.punch.shape", .type = KeyType::choice, .presence = required, .choices = {"hemisphere"}, .stage = stamping,
       .used_when = "!tools.punch.file", .help = "Hemisphere with its apex down and a cylinder above."},
      {.path = "tools.punch.radius", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 10000 mm)", .stage = stamping, .used_when = "!tools.punch.file", .help = "Of hemisphere and cylinder."},
  };
  append(keys, tool_file_keys("punch"));
  keys.push_back(tool_friction_key("punch"));
  append(keys, {
      {.path = "tools.die.shape", .type = KeyType::choice, .presence = required, .choices = {"ring"}, .stage = stamping,
       .used_when = "!tools.die.file", .help = "Plate with a round opening and a filleted edge."},
      {.path = "tools.die.opening_radius", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 10000 mm)", .stage = stamping, .used_when = "!tools.die.file",
       .help = "Radius of the opening below the fillet."},
      {.path = "tools.die.fillet", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 10000 mm)", .stage = stamping, .used_when = "!tools.die.file", .help = "Radius of the rounded edge."},
      {.path = "tools.die.bottom", .type = KeyType::choice, .presence = defaulted, .default_text = "open",
       .choices = {"open", "flat", "bowl"}, .stage = stamping, .used_when = "!tools.die.file",
       .help = "What closes the opening below: nothing, a level floor, or a bowl of the opening's radius."},
      {.path = "tools.die.depth", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 10000 mm)", .stage = stamping, .used_when = "!tools.die.file !tools.die.bottom=open",
       .help = "Of that bottom's lowest point below the die's face."},
  });
  append(keys, tool_file_keys("die"));
  keys.push_back(tool_friction_key("die"));
  append(keys, {
      {.path = "tools.binder.shape", .type = KeyType::choice, .presence = required, .choices = {"ring"}, .stage = stamping,
       .used_when = "!tools.binder.file", .help = "Flat ring under force, free to move up and down."},
      {.path = "tools.binder.inner_radius", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 10000 mm)", .stage = stamping, .used_when = "!tools.binder.file", .help = "Where the binder begins."},
      {.path = "tools.binder.edge_fillet", .type = KeyType::quantity, .unit = "mm", .presence = defaulted,
       .default_text = "2 mm", .range = "(0 mm, 1000 mm)", .stage = stamping,
       .used_when = "!tools.binder.file",
       .help = "Rounding of the inner edge; keeps contact smooth where fabric leaves it."},
      {.path = "tools.binder.mass", .type = KeyType::quantity, .unit = "kg", .presence = required,
       .range = "(0 kg, )", .stage = stamping, .used_when = "tools.binder.control=force", .help = "Of the moving binder."},
      {.path = "tools.binder.control", .type = KeyType::choice, .presence = defaulted, .default_text = "force",
       .choices = {"force", "gap"}, .stage = stamping,
       .help = "force: pressed by process.binder_force, free to move up and down; gap: held by stops at tools.binder.gap."},
      {.path = "tools.binder.gap", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 1000 mm)", .stage = stamping, .used_when = "tools.binder.control=gap",
       .help = "Between the faces of binder and die; less than the fabric's thickness presses it."},
      {.path = "tools.binder.stiffness", .type = KeyType::quantity, .unit = "N/mm", .presence = defaulted,
       .default_text = "0 N/mm", .range = "[0 N/mm, )", .stage = stamping, .used_when = "tools.binder.control=force",
       .help = "Of springs behind the binder: its force is process.binder_force where it has closed on the flat blank and grows by this as it is lifted."},
      {.path = "tools.binder.tilt", .type = KeyType::choice, .presence = defaulted, .default_text = "held",
       .choices = {"held", "free"}, .stage = stamping, .used_when = "tools.binder.control=force",
       .help = "held: the binder stays level (or at the angle of effects.binder_tilt); free: it turns about level axes as the fabric below it asks."},
      {.path = "tools.binder.sectors", .type = KeyType::integer, .presence = defaulted, .default_text = "1",
       .range = "[1, 64]", .stage = stamping, .used_when = "!tools.binder.file",
       .help = "Equal sectors of the binder, the first about x, each with its share of force, springs and mass and free to move by itself."},
  });
  append(keys, tool_file_keys("binder"));
  keys.push_back(tool_friction_key("binder"));
  return keys;
}
// clang-format on

}  // namespace heddle::pipeline
