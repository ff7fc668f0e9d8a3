// What the display pass of the device shows (shaders/display/), in double on the processor: for
// colours that are no frame's.
#pragma once

#include "engine/optics/colour.h"
#include "engine/problem.h"

namespace cyanometer {

/// The colour nearest to grey of the same luminance that has nothing negative; black where that
/// is negative.
Triple into_gamut(const Triple& rgb);

/// Linear Rec. 709 in an image's unit to the display's: exposure times white balance.
Matrix display_matrix(const Output& output, double exposure_ev);

class Displayed {
 public:
  Displayed(const Image& image, const Output& output, double exposure_ev);
  /// sRGB, 0 to 255, before it is rounded to 8 bits. @param rgb in the image's unit
  Triple levels(const Triple& rgb) const;

 private:
  int tone_map_;
  Matrix matrix_;
};

/// L*, a*, b* of levels, rounded to those of 8 bits.
Triple lab_of_levels(const Triple& levels);

}  // namespace cyanometer
