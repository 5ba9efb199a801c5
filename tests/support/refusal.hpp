/// \file The message with which an operation refuses its input.
#pragma once

#include "support/catch.hpp"
#include "support/names.hpp"

#include <stdexcept>
#include <string>

namespace touchtrial {

/// The message of the error of this type that the call throws; empty if it throws nothing.
template <typename ErrorType, typename Call>
[[nodiscard]] std::string message_of(Call&& call) {
  try {
    static_cast<void>(call());
  } catch (const ErrorType& error) {
    return error.what();
  }
  return {};
}

/// Whether the call throws an error of the type whose message names `places` (support/names.hpp);
/// without places any such error will do.
template <typename ErrorType, typename Call>
[[nodiscard]] bool refuses(Call&& call, const std::string& places = {}) {
  const std::string message = message_of<ErrorType>(call);
  UNSCOPED_INFO(message);
  return !message.empty() && (places.empty() || names(message, places));
}

}  // namespace touchtrial
