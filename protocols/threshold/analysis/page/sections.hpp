/// \file The page of a threshold study and its sections, as its results use them.
#pragma once

#include "analysis/report/page/document.hpp"
#include "analysis/report/page/study_document.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// A threshold with its interval, in dB: "−21.3 [−23.0, −19.6]". A censored one: "below −40.0",
/// "not determined, above −20.0"; an end that was not found: "open".
/// \param levels  of the track
[[nodiscard]] std::string threshold_text(const procedures::Threshold& threshold,
                                         const std::vector<double>& levels);
/// "−12.5", "above 0.0" or "between −5.0 and −2.5"; empty if nothing is known of it.
[[nodiscard]] std::string median_text(const CensoredMean& mean);
/// How the mean takes people who are not determined, without a full stop; empty without a mean or
/// without such people.
[[nodiscard]] std::string taken_words(const StandardReport& one);
/// "11.5% [9.8, 13.4]", or the change of an order: "0.120 [0.101, 0.140]"
[[nodiscard]] std::string quantity_text(const Quantity& quantity,
                                        const study::threshold::ThresholdOptions& options);
/// What quantity_text shows: "Weber fraction", "change of order"; empty for detection.
[[nodiscard]] std::string quantity_name(const study::threshold::ThresholdOptions& options);

/// \return a section without blocks if the question is another one
[[nodiscard]] Section same_different_section(const ThresholdReport& report);
/// Whether anybody could hear it with the hand off the device: then thresholds may reflect hearing.
[[nodiscard]] bool was_heard(const ThresholdReport& report);
/// Whether anybody could hear it with the hand off the device, who, and the means without them; or
/// what the block could have found.
[[nodiscard]] std::string sound_sentence(const ThresholdReport& report);
/// The control block with the hand off the device, and the catch trials.
[[nodiscard]] Section control_section(const ThresholdReport& report);
/// Preferred choices, repeated answers and learning.
[[nodiscard]] Section habits_section(const ThresholdReport& report);

/// The report after unblinding.
/// \param pictures  in the order in which they appear
[[nodiscard]] Document threshold_document(const ThresholdReport& report,
                                          const Provenance& provenance,
                                          const Pictures& pictures = {});

}  // namespace touchtrial::analysis::threshold
