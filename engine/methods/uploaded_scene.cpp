#include "engine/methods/uploaded_scene.h"

#include <span>

namespace cyanometer {
namespace {

using Bytes = std::span<const std::byte>;

std::vector<Bytes> arrays(const Physics<float>& p) {
  auto bytes = [](const auto& vector) { return Bytes(std::as_bytes(std::span(vector))); };
  return {vulkan::bytes_of(p.scene),   bytes(p.media),        bytes(p.spectra),
          bytes(p.profile_nodes), bytes(p.phase_angles), bytes(p.phase_values),
          bytes(p.sun_points),    bytes(p.directions)};
}

/// One buffer for all arrays: where each begins, and its size. Empty ones keep room for one element,
/// because a binding can't be empty.
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

}  // namespace

UploadedScene::UploadedScene(vulkan::Device& device, const Physics<float>& physics)
    : parts_(lay_out(arrays(physics), device.limits().storage_alignment)),
      buffer_(device, parts_.back().first + parts_.back().second, vulkan::Memory::device),
      constants_(specialization(physics)),
      groups_(physics.GROUPS),
      media_(physics.MEDIA),
      disc_points_(physics.scene.disc_points) {
  std::vector<Bytes> bytes = arrays(physics);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (!bytes[i].empty()) buffer_.write(parts_[i].first, bytes[i]);
  }
}

std::vector<vulkan::Binding> UploadedScene::bind(
    std::initializer_list<vulkan::Binding> own) const {
  std::vector<vulkan::Binding> all;
  for (auto [offset, size] : parts_) all.emplace_back(buffer_, offset, size);
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace cyanometer
