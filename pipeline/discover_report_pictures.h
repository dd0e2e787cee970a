#pragma once

#include <string>
#include <vector>

#include "pipeline/painter.h"

/// Pictures that only a discovery's report draws. Shares are drawn in per cent.
namespace heddle::pipeline {

/// One field of a matrix over two factors.
struct MatrixField {
  double value = 0.0;  ///< share of the force
  double noise = 0.0;  ///< its standard deviation
  int cells = 0;       ///< conditions behind it; 0: never measured, drawn empty
};

/// A signed share over two factors: coloured fields with numbers, pale where noise alone may give them.
struct MatrixPicture {
  std::string label;         ///< what the picture shows, for readers who cannot see it
  std::string across, down;  ///< factors with their units
  std::vector<std::string> columns, rows;
  std::vector<MatrixField> fields;  ///< row by row
  double full = 0.1;                ///< share at which the colour is full
  double width = 496.0;             ///< [px]; the height follows
};
Canvas draw(const MatrixPicture& picture);

struct Bar {
  std::string name;
  double length = 0.0;
  std::string words;    ///< right of the bar
  bool strong = false;  ///< in the colour of what is meant
};

/// Bars from zero, one below the other, with a line at a value that counts.
struct BarPicture {
  std::string label, quantity;
  std::vector<Bar> bars;
  double mark = 0.0;  ///< drawn as a dashed line
  std::string mark_words;
  double name_room = 300.0, words_room = 150.0;  ///< [px]
  double width = 1020.0;
};
Canvas draw(const BarPicture& picture);

/// One condition that no fit saw.
struct BeforeAfter {
  std::string name;
  double before = 0.0, after = 0.0, noise = 0.0;  ///< shares of the force
};

/// One row a condition: a hollow mark before, a full one after, and the reach of noise behind them.
struct BeforeAfterPicture {
  std::string label;
  std::vector<BeforeAfter> rows;
  double width = 1020.0;
};
Canvas draw(const BeforeAfterPicture& picture);

}  // namespace heddle::pipeline
