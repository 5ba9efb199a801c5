/// \file What the image libraries print, and which of it means that data is damaged.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace touchtrial::engine {

/// \param printed  what libjpeg, libpng, libtiff and OpenCV wrote while they decoded
/// \return the first line that tells of damaged pixels, or nothing if there is none. Notes about
///   metadata are not damage, nor are a few bytes of padding before the end of a JPEG.
[[nodiscard]] std::optional<std::string> damage_in(std::string_view printed);

}  // namespace touchtrial::engine
