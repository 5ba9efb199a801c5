/// \file The message with which an operation refuses its input.
#pragma once

#include "support/catch.hpp"
#include "support/names.hpp"

#include <string>

namespace touchtrial {

/// The message of the error that the call throws; fails the test if it throws none.
template <typename ErrorType, typename Call>
[[nodiscard]] std::string message_of(const Call& call) {
  try {
    static_cast<void>(call());
  } catch (const ErrorType& error) {
    return error.what();
  }
  FAIL("nothing was refused");
  return {};
}

/// Whether the call throws an error of the type whose message names `places` (support/names.hpp);
/// without places any such error will do.
template <typename ErrorType, typename Call>
[[nodiscard]] bool refuses(const Call& call, const std::string& places = {}) {
  const std::string message = message_of<ErrorType>(call);
  UNSCOPED_INFO(message);
  return places.empty() || names(message, places);
}

}  // namespace touchtrial
