/// \file The source paper's figures and tables beside the measured ones, as a document and as JSON.
/// Every statement about agreement is computed from the measures. docs/paper.md is this document
/// for the program's own pictures.
#pragma once

#include "analysis/paper/paper_measures.hpp"
#include "analysis/paper/paper_pictures.hpp"
#include "analysis/report/page/document.hpp"

#include <string>

namespace touchtrial::analysis {

/// \param measures  of at least one picture
/// \param sweep  Fig. 3, drawn or without an SVG
/// \param source  the origin of the pictures, in words
[[nodiscard]] Document paper_document(const PaperMeasures& measures, const PaperPictures& pictures,
                                      const Picture& sweep, const std::string& source);

/// docs/data-dictionary.md, "Paper", explains the members.
[[nodiscard]] std::string paper_json(const PaperMeasures& measures);

}  // namespace touchtrial::analysis
