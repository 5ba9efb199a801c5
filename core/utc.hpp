/// \file Times as text, in UTC and independent of the locale.
#pragma once

#include <chrono>
#include <string>

namespace touchtrial {

/// A time since 1970 as ISO 8601, "2026-01-31T14:05:09Z".
/// \param since_1970  in the years 0 to 9999; nanoseconds cannot leave this range
[[nodiscard]] std::string utc_text(std::chrono::seconds since_1970);
[[nodiscard]] inline std::string utc_text(std::chrono::nanoseconds since_1970) {
  return utc_text(std::chrono::floor<std::chrono::seconds>(since_1970));
}

/// "2026-01-31 14:05 UTC", for people.
[[nodiscard]] std::string utc_words(std::chrono::nanoseconds since_1970);
/// "2026-01-31"
[[nodiscard]] std::string utc_day(std::chrono::nanoseconds since_1970);

}  // namespace touchtrial
