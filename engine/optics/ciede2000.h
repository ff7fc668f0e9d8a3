// CIELAB and the colour difference CIEDE2000.
#pragma once

#include "engine/optics/colour.h"

namespace cyanometer {

/// L*, a*, b* under the white D65, of XYZ in which that white's Y is 1 [CIE 015:2018, 8.2.1].
Triple lab_from_xyz(const Triple& xyz);
/// The inverse.
Triple xyz_from_lab(const Triple& lab);

/// L*, a*, b* of sRGB as it is stored, 0 to 1 [IEC 61966-2-1].
Triple lab_from_srgb(const Triple& encoded);

/// The difference of two colours L*, a*, b* with the weights kL = kC = kH = 1; about 1 is seen
/// side by side. [Sharma, Wu and Dalal 2005: The CIEDE2000 color-difference formula, eqs. 2 to
/// 22]
double ciede2000(const Triple& lab1, const Triple& lab2);

}  // namespace cyanometer
