// The tables as pictures, to look at: any of the encoders writes them.
#pragma once

#include <string>
#include <vector>

#include "engine/methods/bruneton/tables.h"

namespace cyanometer::bruneton {

struct TablePicture {
  std::string name;
  std::string axes;  ///< what is across and what is down, in words
  Frame frame;       ///< a plane for each wavelength ("550nm"), and pixels to display
};

/// Of the source: panels of all directions (azimuth across, zenith angle down), one for each
/// sun across and each altitude down, as refined. Of the view: all directions likewise, for
/// each sun and altitude that the table is for. And of the diffuse irradiance of the ground,
/// the sun across. Values are those of the tables, 1/sr, per unit of the sun's irradiance.
std::vector<TablePicture> pictures(TableMaker& maker, Tracer& tracer,
                                   const UploadedScene& scene, const Setup& setup);

}  // namespace cyanometer::bruneton
