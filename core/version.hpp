/// \file The program's version, which every study records.
#pragma once

#include <string_view>

namespace touchtrial {

/// For instance "0.1.0".
[[nodiscard]] std::string_view program_version() noexcept;

}  // namespace touchtrial
