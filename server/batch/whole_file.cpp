#include "server/batch/whole_file.h"

#include <fstream>
#include <stdexcept>

namespace cyanometer {

void write_whole(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::path unfinished = file;
  unfinished += ".part";
  std::ofstream out(unfinished, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(unfinished, file, error);
  if (out && !error) return;
  std::filesystem::remove(unfinished, error);
  throw std::runtime_error("cannot write " + file.string());
}

}  // namespace cyanometer
