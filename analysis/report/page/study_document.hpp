/// \file The document of a study's report, in the order of a results section. Docs: docs/report.md.
#pragma once

#include "analysis/outcomes/quality.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/page/document.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Identifies the database from which a report was made.
struct Provenance {
  std::string database;         ///< file name, without its folder
  std::string program_version;  ///< version of the program that made the report
  std::string seal;             ///< commitment made before trial 1, hexadecimal
  record::ChainHead head;       ///< head of the file's chain
  record::StudyState state;
  std::string texts{};         ///< note on the participants' texts; may be empty
  bool unverified = false;     ///< as any_ran_unverified
  std::string head_summary{};  ///< HeadCheck::words; empty: no head file was compared
  bool is_incomplete = false;  ///< the database lacks events that a head file records
};

/// \param database  file name to show
[[nodiscard]] Provenance provenance_of(const record::StudyStore& store,
                                       const std::string& database);

/// The warning of a report with sessions on a device without a valid certificate.
[[nodiscard]] std::string unverified_banner();

/// The stamp that follows SIMULATED on every table and figure: those of PILOT, INTERIM LOOK and
/// UNVERIFIED DEVICE that hold, or empty.
[[nodiscard]] std::string further_stamp(bool pilot, const Provenance& provenance);

/// Pictures for a report.
using Pictures = std::vector<Picture>;

/// The frame of every protocol's report: title, banners, header, warnings and participants.
///
/// \param headline  the result in a few sentences, then tables; stands first. Before it comes the
///   verdict on the registered question; before its tables, what the result is about and what to
///   bear in mind
/// \param results  the protocol's other sections, in their order; empty ones are left out
/// \param pictures  in their order; each follows the sentences of its section, or of its
///   subheading. If none belongs to the result, the first one does. One whose section is none of
///   these is folded under the result, and one without a section is left out.
[[nodiscard]] Document framed_document(const StudyHead& head, Section headline,
                                       std::vector<Section> results, const Provenance& provenance,
                                       const Pictures& pictures = {});

/// The report before unblinding: how data collection proceeds, and nothing about outcomes.
[[nodiscard]] Document quality_document(const QualityReport& report, const Provenance& provenance);

}  // namespace touchtrial::analysis
