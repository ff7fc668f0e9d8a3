// The first order of each constituent without its phase function, km of lit and attenuated density, over
// the grid of rays [Bruneton and Neyret 2008, section 4]. Or, in less room: the molecules' sum (with
// their coefficients), and of every kind of particles the first wavelength alone, from which the others
// are made in the colours of the molecules. Define SINGLE_BINDING first; the particles' follow.
layout(constant_id = 13) const bool SEPARATE = true;

layout(std430, binding = SINGLE_BINDING) restrict buffer SingleBuffer { Vec4 singles[]; };
layout(std430, binding = SINGLE_BINDING + 1) restrict buffer ParticleBuffer {
  Real first_wavelengths[];
};

bool molecular(int c) { return medium(c).phase == PHASE_RAYLEIGH; }
