/// \file Reads gzip files in memory.
#pragma once

#include "core/bytes.hpp"

#include <string>

namespace touchtrial {

/// Fails the test if the bytes are no gzip file.
[[nodiscard]] std::string gunzip(const Bytes& packed);

}  // namespace touchtrial
