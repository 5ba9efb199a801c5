/// \file The program's version, which every study records. CMakeLists.txt defines it.
#pragma once

#include <string_view>

namespace touchtrial {

/// For instance "1.2.3".
[[nodiscard]] std::string_view program_version() noexcept;

}  // namespace touchtrial
