// Values over four coordinates as a picture: panels in rows and columns, labelled.
#pragma once

#include <string>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

struct Panels {
  /// One coordinate.
  struct Axis {
    std::string quantity;             ///< what it is, with its unit
    std::vector<std::string> labels;  ///< of all panels across or down; in a panel, of its
                                      ///< first, middle and last node
    int nodes = 1;
  };

  std::string name;    ///< for a file
  std::string title;   ///< what the values are, with their unit
  Axis rows, columns;  ///< of panels
  Axis down, across;   ///< in each panel
  std::vector<double> wavelengths_nm;
  /// By wavelength: all nodes across, for each node down, for each panel across, for each down.
  std::vector<std::vector<float>> values;
};

/// Adds the wavelengths of panels over the same coordinates.
void append_wavelengths(const Panels& more, Panels& panels);

/// Red, green and blue are the first, the middle and the last wavelength, each evenly in the
/// logarithm: white is the brightest value, black a millionth of it or less. Of many panels
/// some are shown, evenly chosen, the first and the last among them.
/// @returns a frame of pixels alone, without planes
Frame picture_of(const Panels& panels);

}  // namespace cyanometer
