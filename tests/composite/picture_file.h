// Pictures as clients send them: OpenEXR files of any float channels.
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace cyanometer::testing {

class FileInMemory : public Imf::OStream {
 public:
  FileInMemory() : OStream("memory") {}
  void write(const char c[], int n) override {
    const auto size = static_cast<std::size_t>(n);
    bytes.resize(std::max(bytes.size(), at_ + size));
    std::memcpy(bytes.data() + at_, c, size);
    at_ += size;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t at) override { at_ = at; }

  std::string bytes;

 private:
  std::size_t at_ = 0;
};

using Channels = std::map<std::string, std::vector<float>>;  ///< rows from the top

/// @param more  sets attributes of the header
inline std::string picture_file(
    int width, int height, Channels channels,
    const std::function<void(Imf::Header&)>& more = [](Imf::Header&) {}) {
  Imf::Header header(width, height);
  more(header);
  Imf::FrameBuffer buffer;
  for (auto& [name, plane] : channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()),
                                   sizeof(float), sizeof(float) * std::size_t(width)));
  }
  FileInMemory stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(height);
  }
  return stream.bytes;
}

/// One colour at one distance everywhere.
inline std::string even_picture(int width, int height, float colour, float distance_km) {
  const std::vector<float> plane(std::size_t(width) * std::size_t(height), colour);
  const std::vector<float> z(plane.size(), distance_km);
  return picture_file(width, height, {{"R", plane}, {"G", plane}, {"B", plane}, {"Z", z}});
}

}  // namespace cyanometer::testing
