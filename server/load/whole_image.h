// Whether an image came to its end.
#pragma once

#include <string_view>

namespace cyanometer {

/// False where a PNG, a JPEG or an EXR was cut off. Of other types it is the length alone that
/// tells, and the client looks at that.
bool is_whole_image(std::string_view bytes, std::string_view media_type);

}  // namespace cyanometer
