/// \file What kind of picture a file is, by its first bytes; its name does not matter.
#pragma once

#include "core/bytes.hpp"

namespace touchtrial::engine {

enum class ImageKind { png, jpeg, tiff, bmp, pnm };

/// \throws ImageFault if it is a picture of a kind that is not supported, or not a picture
[[nodiscard]] ImageKind kind_of_image(ByteView file);

}  // namespace touchtrial::engine
