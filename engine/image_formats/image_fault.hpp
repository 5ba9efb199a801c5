/// \file What can be wrong with a picture, before the file's name is known to the message.
#pragma once

#include "engine/image_file.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::engine {

/// Thrown inside the reader of pictures; `read_grey_image` adds the file's name and makes a
/// FileError of it.
struct ImageFault {
  std::string what;    ///< continues a sentence that starts with the file's name
  std::string remedy;  ///< what the user can do
};

[[noreturn]] inline void throw_truncated_image() {
  throw ImageFault{"is truncated or damaged", "copy or export it again"};
}

[[noreturn]] inline void throw_unsupported_image(const std::string& what) {
  throw ImageFault{what, "save it as 8- or 16-bit grey or RGB, for instance as PNG"};
}

/// No decoder takes longer sides than this (libpng's limit is the smallest).
inline constexpr std::int64_t kMaxSidePx = 1'000'000;

/// Refuses what would be empty or too large, from the header alone.
/// \throws ImageFault
inline void check_image_size(std::int64_t width_px, std::int64_t height_px) {
  const std::string size = std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels";
  if (width_px <= 0 || height_px <= 0) {
    throw ImageFault{"has " + size, "export it again with at least one pixel"};
  }
  if (width_px > kMaxImagePixels / height_px) {
    throw ImageFault{
        "has " + size + ", more than " + std::to_string(kMaxImagePixels) + " pixels in all",
        "crop or shrink it"};
  }
  if (width_px > kMaxSidePx || height_px > kMaxSidePx) {
    throw ImageFault{"has " + size + ", a side longer than " + std::to_string(kMaxSidePx),
                     "crop or shrink it"};
  }
}

}  // namespace touchtrial::engine
