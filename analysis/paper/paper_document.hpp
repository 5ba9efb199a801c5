/// \file Compares the source paper's figures and tables with measured values, as a document and as
/// JSON. Every statement about agreement is computed from the measures. docs/paper.md is this
/// document for the built-in pictures.
#pragma once

#include "analysis/paper/paper_measures.hpp"
#include "analysis/paper/paper_pictures.hpp"
#include "analysis/report/page/document.hpp"

#include <string>

namespace touchtrial::analysis {

/// \param measures  of at least one picture
/// \param sweep  Fig. 3; its SVG may be empty
/// \param source  describes the origin of the pictures
[[nodiscard]] Document paper_document(const PaperMeasures& measures, const PaperPictures& pictures,
                                      const Picture& sweep, const std::string& source);

/// docs/data-dictionary.md, "Paper", explains the members.
[[nodiscard]] std::string paper_json(const PaperMeasures& measures);

}  // namespace touchtrial::analysis
