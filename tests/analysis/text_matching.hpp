/// \file Checks of texts and error messages that work with either version of Catch2.
#pragma once

#include <string>
#include <string_view>

namespace touchtrial {

[[nodiscard]] inline bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// The message of the `Expected` that `work` throws; empty if it does not throw.
template <typename Expected, typename Work>
[[nodiscard]] std::string complaint_of(Work&& work) {
  try {
    work();
  } catch (const Expected& error) {
    return error.what();
  }
  return {};
}

}  // namespace touchtrial
