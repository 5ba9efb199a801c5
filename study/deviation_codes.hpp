/// \file The codes of the protocol deviations that the program records.
/// Docs: docs/data-dictionary.md.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace touchtrial::study {

/// Recorded in place of a certificate's hash if the experimenter ran the session on a
/// force-feedback device without a valid certificate.
inline constexpr const char* kUnverifiedDevice = "UNVERIFIED DEVICE";
/// The code of that deviation.
inline constexpr const char* kUnverifiedDeviceCode = "unverified-device";

/// All codes, in alphabetical order.
inline constexpr auto kDeviationCodes = std::to_array<std::string_view>({"answers-lost",
                                                                         "clock-set-back",
                                                                         "comfort-stop",
                                                                         "database-locked",
                                                                         "focus-lost",
                                                                         "key-at-station",
                                                                         "key-not-erased",
                                                                         "no-blindfold",
                                                                         "no-calibration",
                                                                         "no-certificate",
                                                                         "no-consent",
                                                                         "no-curtain",
                                                                         "no-fixture-touch",
                                                                         "no-fixture-touch-after",
                                                                         "no-gravity-compensation",
                                                                         "no-headphones",
                                                                         "no-labels-learnt",
                                                                         "no-masking-level",
                                                                         "no-masking-noise",
                                                                         "no-placement",
                                                                         "no-questions-after",
                                                                         "no-real-time",
                                                                         "no-warm-up",
                                                                         "not-cleaned",
                                                                         "other-certificate",
                                                                         "other-device",
                                                                         "practice-not-passed",
                                                                         "simulated-device",
                                                                         kUnverifiedDeviceCode,
                                                                         "visit-late",
                                                                         "wrong-clock"});

/// Whether a code is one of these, or names an item of the study's own day sheet
/// ("no-day-sheet-3").
[[nodiscard]] constexpr bool is_deviation_code(std::string_view code) noexcept {
  constexpr std::string_view kItem = "no-day-sheet-";
  const bool is_of_day_sheet =
      code.size() > kItem.size() && code.starts_with(kItem) && code[kItem.size()] != '0' &&
      code.find_first_not_of("0123456789", kItem.size()) == std::string_view::npos;
  return is_of_day_sheet ||
         std::find(kDeviationCodes.begin(), kDeviationCodes.end(), code) != kDeviationCodes.end();
}

}  // namespace touchtrial::study
