/// \file What a study's report says, in the order of a results section. Docs: docs/report.md.
#pragma once

#include "analysis/page/document.hpp"
#include "analysis/report/quality.hpp"
#include "analysis/report/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// By what a reader can tell that a report is of this database.
struct Provenance {
  std::string database;         ///< file name, without its folder
  std::string program_version;  ///< that made the report
  std::string seal;             ///< commitment before trial 1, hexadecimal
  store::ChainHead head;        ///< of the file's chain
  store::StudyState state;
};

/// \param database  file name to show
[[nodiscard]] Provenance provenance_of(const store::StudyStore& store, const std::string& database);

/// What stands on every table and figure beside SIMULATED: PILOT, INTERIM LOOK, or nothing.
[[nodiscard]] std::string further_stamp(const StudyReport& report, const Provenance& provenance);

/// A picture for a report, whose id says to which section it belongs (docs/report.md).
using Pictures = std::vector<Picture>;

/// The report after unblinding. \param pictures  in the order in which they are to stand
[[nodiscard]] Document study_document(const StudyReport& report, const Provenance& provenance,
                                      const Pictures& pictures = {});

/// The report before unblinding: how collection goes, and nothing of outcomes.
[[nodiscard]] Document quality_document(const QualityReport& report, const Collection& collection,
                                        const Provenance& provenance);

}  // namespace touchtrial::analysis
