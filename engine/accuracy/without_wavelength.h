// A scene with one of its given wavelengths less.
#pragma once

#include <cstddef>

#include "engine/scene/scene.h"

namespace cyanometer {

/// Spectra that are given by wavelength lose the value that belongs to it.
/// @param index  of `spectrum.wavelengths_nm`, which holds more than one
Scene without_wavelength(const Scene& scene, std::size_t index);

}  // namespace cyanometer
