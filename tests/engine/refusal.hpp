/// \file The message of a function that refuses its arguments.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace touchtrial {

/// \return the message of the std::invalid_argument that the call throws; empty if it throws
///   nothing
template <typename Call>
[[nodiscard]] std::string refusal_of(Call&& call) {
  try {
    std::forward<Call>(call)();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace touchtrial
