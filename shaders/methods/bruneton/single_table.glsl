// The first order of each constituent without its phase function, km of lit and attenuated density, over
// the grid of rays [Bruneton and Neyret 2008, section 4]. Or, in less room: the molecules' sum (with
// their coefficients), and of every kind of particles the first wavelength alone, from which the others
// are made in the colours of the molecules. Define SINGLE_BINDING first; the particles' follow.
layout(constant_id = 13) const bool SEPARATE = true;

layout(binding = SINGLE_BINDING, rgba32f) uniform restrict imageBuffer singles;
layout(binding = SINGLE_BINDING + 1, r32f) uniform restrict imageBuffer first_wavelengths;

bool molecular(int c) { return medium(c).phase == PHASE_RAYLEIGH; }
