/// \file The page of a threshold study and its sections.
#pragma once

#include "analysis/report/page/document.hpp"
#include "analysis/report/page/study_document.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// A threshold with its interval, in dB: "−21.3 [−23.0, −19.6]"; censored: "below −40.0", "not
/// determined, above −20.0". Unknown ends are "open".
/// \param levels  of the track
[[nodiscard]] std::string threshold_text(const procedures::Threshold& threshold,
                                         const std::vector<double>& levels);
/// "−12.5", "above 0.0" or "between −5.0 and −2.5"; empty if unknown
[[nodiscard]] std::string median_text(const CensoredMean& mean);
/// How undetermined thresholds enter the mean, without a full stop; empty without a mean or without
/// such thresholds.
[[nodiscard]] std::string undetermined_words(const StandardReport& standard);
/// "11.5% [9.8, 13.4]", or the change of an order: "0.120 [0.101, 0.140]"
[[nodiscard]] std::string quantity_text(const Quantity& quantity,
                                        const study::threshold::ThresholdOptions& options);
/// The quantity of quantity_text: "Weber fraction", "change of order"; empty for detection.
[[nodiscard]] std::string quantity_name(const study::threshold::ThresholdOptions& options);

/// \return a section without blocks for other questions
[[nodiscard]] Section same_different_section(const ThresholdReport& report);
/// Whether anybody was above chance with the hand off the device, so that thresholds may reflect
/// hearing.
[[nodiscard]] bool was_heard(const ThresholdReport& report);
/// Who could hear the difference with the hand off the device, and the means without them; or what
/// the block could have detected.
[[nodiscard]] std::string sound_sentence(const ThresholdReport& report);
/// The control block with the hand off the device.
[[nodiscard]] Section control_section(const ThresholdReport& report);
/// Learning and preferences for choices.
[[nodiscard]] Section habits_section(const ThresholdReport& report);

/// \param pictures  in their order on the page
[[nodiscard]] Document threshold_document(const ThresholdReport& report,
                                          const Provenance& provenance,
                                          const Pictures& pictures = {});

}  // namespace touchtrial::analysis::threshold
