/// \file The document of a study's report, in the order of a results section. Docs: docs/report.md.
#pragma once

#include "analysis/outcomes/quality.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/page/document.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The database from which a report was made.
struct Provenance {
  std::string database;         ///< file name without folder
  std::string program_version;  ///< of the program that made the report
  std::string seal;             ///< commitment made before trial 1, hexadecimal
  record::ChainHead head;       ///< of the file's chain
  record::StudyState state;
  std::string texts{};         ///< note on the participants' texts; may be empty
  bool unverified = false;     ///< any_ran_unverified
  std::string head_summary{};  ///< HeadCheck::words; empty: no head file was compared
  bool is_incomplete = false;  ///< the database lacks events that a head file records
};

/// \param database  file name to show
[[nodiscard]] Provenance provenance_of(const record::StudyStore& store,
                                       const std::string& database);

/// The warning of a report with sessions on a device without a valid certificate.
[[nodiscard]] std::string unverified_banner();

/// The stamp after SIMULATED on tables and figures: whichever of PILOT, INTERIM LOOK and UNVERIFIED
/// DEVICE apply; may be empty.
[[nodiscard]] std::string further_stamp(bool pilot, const Provenance& provenance);

using Pictures = std::vector<Picture>;

/// Adds the common parts of every report: title, banners, header, verdict, warnings and
/// participants.
/// \param headline  the result in a few sentences, then tables; the first section. The verdict is
///   inserted before it, the facts and warnings before its tables
/// \param results  the protocol's other sections; empty ones are omitted
/// \param pictures  placed below the sentences of their section or subheading. If none belongs to
///   the result, the first one moves there. Pictures with an unknown section are folded under the
///   result; those without a section are omitted
[[nodiscard]] Document framed_document(const StudyHead& head, Section headline,
                                       std::vector<Section> results, const Provenance& provenance,
                                       const Pictures& pictures = {});

/// The report before unblinding: data collection without outcomes.
[[nodiscard]] Document quality_document(const QualityReport& report, const Provenance& provenance);

}  // namespace touchtrial::analysis
