/// \file Checks of texts that work with either version of Catch2.
#pragma once

#include <string_view>

namespace touchtrial {

[[nodiscard]] inline bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

}  // namespace touchtrial
