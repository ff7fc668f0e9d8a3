// The one description of every member of the scene document: its name, type, range, default,
// and what people are told about it. The unit is the suffix of the name, the default is that of
// the struct in scene.h unless `otherwise` says what it follows from. Internal to engine/scene.
#pragma once

#include "engine/scene/object.h"

namespace cyanometer {

/// The whole document but for `preset`.
const Object<Scene>& scene_members();

// Its parts, each in a file of its own.
ObjectOf<SpectrumChoice> spectrum_members();
ObjectOf<Planet> planet_members();
ObjectOf<Atmosphere> atmosphere_members();
ObjectOf<Sun> sun_members();
ObjectOf<Camera> camera_members();
ObjectOf<MethodChoice> method_members();
ObjectOf<Image> image_members();

/// A wavelength that may be computed, in nm.
Spelled<double> wavelength();

/// The forms of a spectrum, with its values within the range at every wavelength that is
/// computed.
Spelled<Spectrum> spectrum(double minimum, double maximum);

Spelled<Constituent> constituent();

Spelled<Surface> surface();

}  // namespace cyanometer
