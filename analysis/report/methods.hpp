/// \file The methods section of a paper: paragraphs to copy, made from what was run and registered.
/// Facts that a study lacks are left out. Docs: docs/report.md.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/page/document.hpp"
#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Sentences with full stops, and the publications that they cite.
using Sentences = std::vector<CitedText>;

/// Sentences of a protocol.
struct ProtocolMethods {
  Sentences trial;       ///< the question of a trial, and how it was answered
  Sentences sequence;    ///< number and order of trials, and the adaptive procedure
  Sentences statistics;  ///< in the order of the page
};

/// Facts from a database and its pack.
struct RecordedStudy {
  std::string program_version{};        ///< at the start of the study; empty: unknown
  std::string seal{};                   ///< hexadecimal; empty: unknown
  std::string pack{};                   ///< digest of the pack, hexadecimal; empty: unknown
  std::optional<double> rate_hz{};      ///< of the servo, from the first trace
  std::vector<engine::Gains> gains{};   ///< of each stimulus; empty: no pack found
  std::vector<double> lateral_rms_n{};  ///< of each stimulus's forces; empty: no pack found
  std::vector<PlaneGeometry> planes{};  ///< distinct sizes of planes; empty: no pack found
};

/// A missing, damaged or different pack leaves gains, forces and planes empty.
[[nodiscard]] RecordedStudy recorded_study(const record::StudyStore& store,
                                           const study::StudyKey& key);

/// The section "methods" of a page, with a subheading for each paragraph: participants, apparatus
/// and stimuli, procedure, data analysis.
/// \param head  of these outcomes
[[nodiscard]] Section methods_section(const StudyHead& head, const Outcomes& outcomes,
                                      const RecordedStudy& recorded,
                                      const ProtocolMethods& protocol);

/// Adds a sentence to the paragraph on stimuli, if the document has a methods section.
void add_to_stimuli(Document& document, const std::string& sentence);

/// The methods section with its references, in Markdown; empty if the document has none.
[[nodiscard]] std::string methods_markdown(const Document& document);

}  // namespace touchtrial::analysis
