/// \file The methods of a study as a paper writes them: paragraphs to be copied, made from what was
/// run and registered. A fact that a study does not have is left out. Docs: docs/report.md.
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

/// Sentences, each with its full stop, and the publications that they name.
using Sentences = std::vector<Cited>;

/// What a protocol says of its study.
struct ProtocolMethods {
  Sentences trial;       ///< what was asked in a trial, and how it was answered
  Sentences sequence;    ///< the number of trials, their order, and the procedure that chose them
  Sentences statistics;  ///< of the protocol's page
};

/// What a database and its pack tell besides the outcomes.
struct RecordedStudy {
  std::string program_version{};        ///< with which the study was begun; empty: not known
  std::string seal{};                   ///< hexadecimal; empty: not known
  std::string pack{};                   ///< digest of the pack, hexadecimal; empty: not known
  std::optional<double> rate_hz{};      ///< of the servo, as the first trace states it
  std::vector<engine::Gains> gains{};   ///< of each stimulus; empty: no pack in reach
  std::vector<double> lateral_rms_n{};  ///< engine::FieldStatistics::tangential_rms_n, likewise
  std::vector<PlaneGeometry> planes{};  ///< the different sizes of planes; empty likewise
};

/// Reads them. A pack that is out of reach, or another one, leaves gains and planes empty.
[[nodiscard]] RecordedStudy recorded_study(const record::StudyStore& store,
                                           const study::StudyKey& key);

/// The section "methods" of a page: participants, apparatus and stimuli, procedure, data analysis,
/// each a paragraph under its subheading.
/// \param head  of these outcomes
[[nodiscard]] Section methods_section(const StudyHead& head, const Outcomes& outcomes,
                                      const RecordedStudy& recorded,
                                      const ProtocolMethods& protocol);

/// Adds a sentence on the stimuli to a document with such a section.
void add_to_stimuli(Document& document, const std::string& sentence);

/// The section alone with its references, in Markdown; empty if the document has none.
[[nodiscard]] std::string methods_markdown(const Document& document);

}  // namespace touchtrial::analysis
