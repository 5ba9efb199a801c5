/// \file The program's version, defined in CMakeLists.txt and recorded in every study.
#pragma once

#include <string_view>

namespace touchtrial {

/// For instance "1.2.3".
[[nodiscard]] std::string_view program_version() noexcept;

}  // namespace touchtrial
