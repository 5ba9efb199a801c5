/// \file Bytes as text, for documents that hold pictures. From libsodium.
#pragma once

#include "core/bytes.hpp"

#include <string>

namespace touchtrial {

/// RFC 4648, section 4: the standard alphabet, padded.
[[nodiscard]] std::string to_base64(ByteView bytes);

}  // namespace touchtrial
