/// \file Asserts that an operation refuses its input, and with which message.
#pragma once

#include "support/catch.hpp"
#include "support/names.hpp"

#include <stdexcept>
#include <string>

namespace touchtrial {

/// The message of the `ErrorType` that the call throws; empty if it throws nothing.
template <typename ErrorType, typename Call>
[[nodiscard]] std::string message_of(Call&& call) {
  try {
    static_cast<void>(call());
  } catch (const ErrorType& error) {
    return error.what();
  }
  return {};
}

/// Whether the call throws an `ErrorType` whose message contains `places` (support/names.hpp);
/// without places, any message.
template <typename ErrorType, typename Call>
[[nodiscard]] bool refuses(Call&& call, const std::string& places = {}) {
  const std::string message = message_of<ErrorType>(call);
  UNSCOPED_INFO(message);
  return !message.empty() && (places.empty() || names(message, places));
}

}  // namespace touchtrial
