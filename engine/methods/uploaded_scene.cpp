#include "engine/methods/uploaded_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace cyanometer {
namespace {

using Bytes = std::span<const std::byte>;

std::vector<Bytes> arrays(const Physics<float>& p) {
  auto bytes = [](const auto& vector) { return Bytes(std::as_bytes(std::span(vector))); };
  return {vulkan::bytes_of(p.scene), bytes(p.media),        bytes(p.spectra),
          bytes(p.profile_nodes),    bytes(p.phase_angles), bytes(p.phase_values),
          bytes(p.sun_points),       bytes(p.directions),   bytes(p.quadrature),
          bytes(p.surface_values),   bytes(p.ends_km)};
}

/// One buffer for all arrays: where each begins, and its size. Empty ones keep room for one
/// element, because a binding can't be empty.
std::vector<std::pair<std::size_t, std::size_t>> lay_out(const std::vector<Bytes>& parts,
                                                         std::size_t alignment) {
  std::vector<std::pair<std::size_t, std::size_t>> places;
  std::size_t offset = 0;
  for (Bytes part : parts) {
    std::size_t size = std::max<std::size_t>(part.size(), 32);
    places.emplace_back(offset, size);
    offset = (offset + size + alignment - 1) / alignment * alignment;
  }
  return places;
}

template <class T>
void append_bytes(std::string& to, const T& values) {
  auto bytes = std::as_bytes(std::span(values));
  to.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

std::string key_of_air(const Physics<float>& p) {
  std::string key;
  append_bytes(key, std::array{p.scene.planet_radius_km, p.scene.thickness_km});
  append_bytes(key, std::array{p.GROUPS, p.EXPONENTIALS, p.TENTS, p.QUADRATICS, p.UNIFORMS});
  append_bytes(key, p.media);
  append_bytes(key, p.spectra);
  append_bytes(key, p.profile_nodes);
  append_bytes(key, p.phase_angles);
  append_bytes(key, p.phase_values);
  return key;
}

Physics<float> packed(const Problem& problem, const std::vector<glm::dvec3>& directions,
                      const RayEnds* ends) {
  Physics<float> physics = pack<float>(problem);
  if (!directions.empty()) set_directions(physics, directions);
  if (ends) physics.scene.ends = ends->count();
  return physics;
}

/// One for each constituent, and for a table those of its binary search.
int iterations(const Physics<float>& physics) {
  int count = physics.MEDIA;
  for (const auto& medium : physics.media) {
    count += std::bit_width(static_cast<unsigned>(medium.profile_nodes));
  }
  return count;
}

}  // namespace

RayEnds::RayEnds(vulkan::Device& device, std::span<const float> km)
    : buffer_(device, km.size_bytes(), vulkan::Memory::host) {
  buffer_.write(0, std::as_bytes(km));
}

namespace {

bool ends(float km) { return km < Physics<float>::ENDLESS; }

}  // namespace

bool RayEnds::any(int first, int count) const {
  return std::ranges::any_of(km().subspan(first, count), ends);
}

bool RayEnds::all(int first, int count) const {
  return std::ranges::all_of(km().subspan(first, count), ends);
}

UploadedScene::UploadedScene(vulkan::Device& device, const Problem& problem,
                             const std::vector<glm::dvec3>& directions,
                             std::shared_ptr<const RayEnds> ends, GroundBuffers ground)
    : UploadedScene(device, problem, packed(problem, directions, ends.get()), ends,
                    std::move(ground)) {}

UploadedScene::UploadedScene(vulkan::Device& device, const Problem& problem,
                             const Physics<float>& physics, std::shared_ptr<const RayEnds> ends,
                             GroundBuffers ground)
    : problem_(problem),
      air_key_(key_of_air(physics)),
      parts_(lay_out(arrays(physics), device.limits().storage_alignment)),
      ends_(std::move(ends)),
      ground_(std::move(ground)),
      constants_(specialization(physics)),
      groups_(physics.GROUPS),
      media_(physics.MEDIA),
      disc_points_(physics.scene.disc_points),
      density_iterations_(iterations(physics)),
      profile_nodes_(static_cast<int>(physics.profile_nodes.size())),
      kinks_(physics.scene.kinks) {
  vulkan::Buffer buffer(device, parts_.back().first + parts_.back().second,
                        vulkan::Memory::device);
  std::vector<Bytes> bytes = arrays(physics);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (!bytes[i].empty()) buffer.write(parts_[i].first, bytes[i]);
  }
  buffer_ = std::make_shared<const vulkan::Buffer>(std::move(buffer));
}

UploadedScene UploadedScene::with_directions(vulkan::Device& device,
                                             const std::vector<glm::dvec3>& directions) const {
  std::vector<glm::vec4> values;
  for (const glm::dvec3& d : directions) values.emplace_back(glm::vec3(d), 0.f);
  const auto bytes = std::as_bytes(std::span(values));
  vulkan::Buffer buffer(device, bytes.size(), vulkan::Memory::device);
  buffer.write(0, bytes);
  UploadedScene other = *this;
  other.directions_ = std::make_shared<const vulkan::Buffer>(std::move(buffer));
  return other;
}

std::vector<vulkan::Binding> UploadedScene::bind(
    std::initializer_list<vulkan::Binding> own) const {
  std::vector<vulkan::Binding> all;
  constexpr std::size_t place_of_directions = 7;  // shaders/device.glsl
  for (auto [offset, size] : parts_) {
    if (directions_ && all.size() == place_of_directions) {
      all.emplace_back(*directions_);
    } else {
      all.emplace_back(*buffer_, offset, size);
    }
  }
  if (ends_) {
    all.pop_back();
    all.emplace_back(ends_->buffer());
  }
  if (ground_.texels) {
    all.emplace_back(*ground_.texels);
  } else {
    all.push_back(all.front());
  }
  for (const vulkan::Binding& binding : own) all.push_back(binding);
  return all;
}

}  // namespace cyanometer
