/// \file gzip files in memory.
#pragma once

#include "core/bytes.hpp"

#include <string_view>

namespace touchtrial::analysis {

/// RFC 1952 with level 4; no name and no time in the header, so that equal contents give equal
/// bytes. \throws FileError if there is no memory
[[nodiscard]] Bytes gzip(std::string_view content);

}  // namespace touchtrial::analysis
