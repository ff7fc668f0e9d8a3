// From the spectral quantities of tiles to the planes of a frame, and from those to displayed
// pixels.
#pragma once

#include <memory>
#include <vector>

#include "engine/display/planes.h"
#include "engine/image/picture.h"
#include "engine/lattice/lattice.h"
#include "engine/methods/method.h"
#include "engine/sky/stars.h"
#include "engine/vulkan/buffer_pool.h"

namespace cyanometer {

/// A frame's planes on the device; the host reads them in place.
struct FrameStore {
  /// @param groups  of planes
  FrameStore(vulkan::Device& device, vulkan::BufferPool& pool, std::size_t pixels,
             std::size_t groups, bool displayed);

  vulkan::Binding plane(std::size_t group, std::size_t k) const;
  std::span<float> samples(std::size_t group, std::size_t k) const;

  /// R, G, B as displayed, 0 to 255, before they are rounded: of pixels that were listed.
  void add_levels(vulkan::BufferPool& pool);
  vulkan::Binding level(std::size_t c) const;
  std::span<float> levels(std::size_t c) const;

  std::size_t pixels;
  std::size_t stride;  ///< floats from one plane to the next
  using Memory = std::shared_ptr<const vulkan::Buffer>;
  std::vector<Memory> buffers;  ///< four planes each
  Memory rgbx;                  ///< null where nothing is displayed
  Memory level_planes;          ///< three in one; null where none were added
};

/// Pixels whose rays are traced as those of a list.
struct PixelList {
  PixelList(vulkan::Device& device, const std::vector<int>& pixels);
  vulkan::Buffer numbers;
  int count;
  bool stars = false;  ///< they are those of a job's stars, which are added
};

/// Exposure at which the geometric mean of the luminance is 0.36, a stop above middle grey; 0
/// of a black frame.
/// @param luminance  of each pixel; what is not positive, or black beside the rest, does not
/// count
/// @param white_card  luminance that is shown as 1 at exposure 0
/// @param areas  that each of them stands for; none where they are equal
double automatic_exposure_ev(std::span<const float> luminance, double white_card,
                             std::span<const float> areas = {});

class Compositor {
 public:
  explicit Compositor(vulkan::Device& device);

  /// What some of a frame's wavelengths add to its planes; the same for all tiles.
  struct Job {
    const std::vector<PlaneGroup>& groups;
    bool first, last;  ///< of the frame's sets of wavelengths
    StarPixels stars;
    vulkan::Buffer matrix;
    std::vector<vulkan::Buffer> star_buffers;  ///< pixels and radiances; none without stars
  };
  /// @param first  the place of the scene's first wavelength in the frame's
  /// @param wavelengths  of the whole frame
  Job prepare(vulkan::Device& device, const UploadedScene& scene,
              const std::vector<PlaneGroup>& groups, std::size_t first,
              std::size_t wavelengths);
  /// Records the planes of one tile: of the frame's pixels with their stars or, where its rays
  /// are directions, of the pixels that are listed.
  void compose(vulkan::Commands& commands, const Job& job, const UploadedScene& scene,
               const Tile& tile, const FrameStore& store, const PixelList* listed = nullptr);
  /// Adds a client's picture as the air before it leaves it.
  /// @param scenes  at all wavelengths of the transmittance, with the ends of the picture's
  /// rays
  /// @param rows    transmittance_rows at these
  void overlay(Tracer& tracer, const std::vector<UploadedScene>& scenes,
               const std::array<std::vector<double>, 3>& rows, const Picture& picture,
               const std::vector<PlaneGroup>& groups, const std::array<double, 3>& luminance,
               const FrameStore& store);
  /// Fills `store.rgbx` from the first group's planes.
  void display(Tracer& tracer, const Image& image, const Output& output, double exposure_ev,
               const FrameStore& store);
  /// The same of pixels that are listed, with their levels.
  void display(Tracer& tracer, const Image& image, const Output& output, double exposure_ev,
               const FrameStore& store, const PixelList& listed);
  /// Fills `store.rgbx` or, where nothing is displayed, R, G and B, with nothing that was
  /// computed.
  /// @returns its time, ms
  double store_only(Tracer& tracer, const FrameStore& store);
  /// Records what lies between a lattice's rays: `store.rgbx` where there are levels, else the
  /// groups' planes.
  void fill(Tracer& tracer, const Lattice& lattice, const std::vector<PlaneGroup>& groups,
            const FrameStore& store);

 private:
  void display(Tracer& tracer, const Image& image, const Output& output, double exposure_ev,
               const FrameStore& store, const PixelList* listed);
  void compose_stars(vulkan::Commands& commands, const Job& job, const UploadedScene& scene,
                     const Tile& tile, std::size_t group, std::vector<vulkan::Binding> bindings,
                     const PixelList* listed);

  vulkan::Kernel compose_, stars_, overlay_, display_, fill_levels_, fill_planes_, store_;
  StarLight star_light_;
};

}  // namespace cyanometer
