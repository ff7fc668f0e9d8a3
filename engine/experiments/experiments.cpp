#include "engine/experiments/experiments.h"

namespace cyanometer {

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> all{
      {"pairs", "Samples of the nested march",
       "A thesis told its frames a second for ten pairs of samples along the view ray and "
       "towards "
       "the sun. Its scene again, in order one, with what the pairs miss.",
       sample_pairs},
      {"map", "Do samples towards the sun matter more?",
       "It also found that samples towards the sun matter more than those along the view ray. "
       "The "
       "same scene by both, from 2 x 1 to 256 x 256.",
       sample_map},
      {"orders", "Orders of scattering",
       "What is left out where light is followed through so many orders alone.", orders_kept},
      {"top", "Does a high top whiten the planet?",
       "The thesis's planet from 12000 km grew whiter with the height of its air's top. Scale "
       "heights stay, so that there is next to nothing in the air that is added: what grows "
       "are "
       "the steps of a march with a fixed number of samples. Saturation is 1 - least / largest "
       "of "
       "the three wavelengths, in the mean over lit rays.",
       heights_of_the_top},
      {"mappings", "Mappings of precomputed tables",
       "Tables of 8 altitudes, 16 zeniths on each side, 16 suns and 7 azimuths that hold all "
       "orders, read linearly.",
       table_mappings},
      {"quadratic", "Air that thins out as a square",
       "A planet renderer's profile, (1 - h / top)^2, against exponential air of the same "
       "column, "
       "from the ground.",
       quadratic_air},
      {"hdr", "High dynamic range",
       "The nested march converged, and the air and the few samples of a graphics card of 2004 "
       "[O'Neil 2005, GPU Gems 2, chapter 16], both with order one alone and a sun at 6 "
       "degrees.",
       with_and_without_hdr}};
  return all;
}

}  // namespace cyanometer
