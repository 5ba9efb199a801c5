/// \file The page of a rating study.
#pragma once

#include "analysis/report/page/study_document.hpp"
#include "protocols/rating/analysis/report.hpp"

namespace touchtrial::analysis::rating {

/// \param pictures  in their order on the page
[[nodiscard]] Document rating_document(const RatingReport& report, const Provenance& provenance,
                                       const Pictures& pictures = {});

/// \name Sections of the page, without blocks if there are no ratings
/// \{

/// Means by method and class, and by item.
/// \param has_figure  folds the table of items
[[nodiscard]] Section means_section(const RatingReport& report, bool has_figure);
[[nodiscard]] Section differences_section(const RatingReport& report);
/// Agreement between and within participants.
[[nodiscard]] Section reliability_section(const RatingReport& report);
[[nodiscard]] Section use_section(const RatingReport& report);
[[nodiscard]] Section catches_section(const RatingReport& report);

/// \}

/// "caption", or "caption (scale fit)" in a report with several scales.
[[nodiscard]] std::string caption_of(const RatingReport& report, const ScaleReport& scale,
                                     const std::string& caption);
/// "name", or "name-2" in a report with several scales: unique in a document.
[[nodiscard]] std::string id_of(const RatingReport& report, const ScaleReport& scale,
                                const std::string& name);

}  // namespace touchtrial::analysis::rating
