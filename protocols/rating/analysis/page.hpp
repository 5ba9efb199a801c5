/// \file The page of a rating study.
#pragma once

#include "analysis/report/page/study_document.hpp"
#include "protocols/rating/analysis/report.hpp"

namespace touchtrial::analysis::rating {

/// The report after unblinding.
/// \param pictures  in the order in which they appear
[[nodiscard]] Document rating_document(const RatingReport& report, const Provenance& provenance,
                                       const Pictures& pictures = {});

/// \name Sections of the page. Without a rating they have no blocks.
/// \{

/// Means by method and class, and by item.
/// \param drawn  whether a figure shows the items, so that their table is folded
[[nodiscard]] Section means_section(const RatingReport& report, bool drawn);
/// Differences between methods.
[[nodiscard]] Section differences_section(const RatingReport& report);
/// Agreement between participants, and of participants with themselves.
[[nodiscard]] Section reliability_section(const RatingReport& report);
/// Use of the scale by participant.
[[nodiscard]] Section use_section(const RatingReport& report);
/// Catch trials beside scored ones.
[[nodiscard]] Section catches_section(const RatingReport& report);

/// \}

/// "caption", and of several scales which one it is of.
[[nodiscard]] std::string caption_of(const RatingReport& report, const ScaleReport& scale,
                                     const std::string& caption);
/// "name", and of several scales the number of this one: unique in a document.
[[nodiscard]] std::string id_of(const RatingReport& report, const ScaleReport& scale,
                                const std::string& name);

}  // namespace touchtrial::analysis::rating
