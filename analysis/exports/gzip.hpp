/// \file Compresses bytes with gzip in memory.
#pragma once

#include "core/bytes.hpp"

#include <string_view>

namespace touchtrial::analysis {

/// Compresses at level 4 in the format of RFC 1952. The header has no name and no time, so that
/// equal contents give equal bytes.
/// \throws FileError if there is not enough memory
[[nodiscard]] Bytes gzip(std::string_view content);

}  // namespace touchtrial::analysis
